// SPDX-License-Identifier: Apache-2.0
// image_io/jpeg_writer.h: encodes JPEG pictures in memory with libjpeg-turbo.
#pragma once

#include <cstdint>
#include <vector>

#include "base/picture.h"

namespace nacre {

// The bytes of a baseline JPEG file with the picture's sRGB codes, without chroma subsampling.
// `quality` is libjpeg's, from 1 to 100. Nothing is written to disk. Throws Error (kInternal) for a
// picture that JPEG cannot hold: without pixels, or with more than 65500 on a side.
std::vector<uint8_t> EncodeJpeg(const Rgb8Picture& picture, int quality);

}  // namespace nacre
