// SPDX-License-Identifier: Apache-2.0
// image_io/exr_reader.h: reads EXR files with OpenEXR.
#pragma once

#include <string>
#include <vector>

#include "image_io/image_file.h"

namespace nacre {

// Opens the scanline and tiled parts of a file (at full resolution, if they have several): all
// channels as floats, ids included, and the headers' attributes as text. Deep parts and parts with
// subsampled channels (luminance and chroma) have a refusal, which is thrown if such a part would
// be read.
//
// Damaged files are refused: missing chunks, chunks of a wrong size, and chunks that cannot be
// decoded. Besides the caller's samples, reading takes memory for a chunk or a row of tiles, which
// is limited like the samples of an image.
//
// `part` and the errors are explained at OpenImage.
ImageFile OpenExr(const std::string& path, const std::string& part = {});

std::vector<ImagePart> DescribeExr(const std::string& path);

}  // namespace nacre
