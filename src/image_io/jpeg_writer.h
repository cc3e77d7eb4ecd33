// SPDX-License-Identifier: Apache-2.0
// image_io/jpeg_writer.h: JPEG pictures in memory, made with libjpeg-turbo.
#pragma once

#include <cstdint>
#include <vector>

#include "base/picture.h"

namespace nacre {

// The bytes of a baseline JPEG file of the picture's sRGB codes, with colours at full resolution.
// `quality`: 1 to 100, as libjpeg has it. No file is written anywhere. Throws Error (kInternal) for
// a picture that JPEG cannot hold: no pixel, or more than 65500 on a side.
std::vector<uint8_t> EncodeJpeg(const Rgb8Picture& picture, int quality);

}  // namespace nacre
