// SPDX-License-Identifier: Apache-2.0
// image_io/exr_reader.h: EXR files, by OpenEXR.
#pragma once

#include <string>
#include <vector>

#include "image_io/image_file.h"

namespace nacre {

// The scanline and tiled parts of a file (at full resolution, if they have several): all channels
// as floats, ids too, and the headers' attributes as text. Deep parts and parts with subsampled
// channels (luminance and chroma) have a refusal; if it would be read, it is thrown.
//
// Damage is refused: chunks that are missing, shorter or longer than what they hold, and those
// that do not decode. Beside the caller's samples, reading takes memory for a chunk or a row of
// tiles, which are held to the samples that an image may have.
//
// OpenImage says what `part` is, and which errors there are.
ImageFile OpenExr(const std::string& path, const std::string& part = {});

std::vector<ImagePart> DescribeExr(const std::string& path);

}  // namespace nacre
