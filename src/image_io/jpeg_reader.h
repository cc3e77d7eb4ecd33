// SPDX-License-Identifier: Apache-2.0
// image_io/jpeg_reader.h: JPEG files, read with libjpeg-turbo.
#pragma once

#include <string>

#include "image_io/image_file.h"

namespace nacre {

// Baseline and progressive files of 8 bits a sample; channels Y or R G B, of CMYK converted as
// Adobe's programs store it. EXIF's orientation is honoured; metadata: "icc_profile" (its
// name, or "sRGB") and "not_srgb" (why not, in words). Beside the caller's samples, reading takes a
// row, or of a progressive file its coefficients, two bytes each. Throws Error (kBadInput) for
// broken files: pixels that the library would make up are refused.
ImageFile OpenJpeg(const std::string& path);

}  // namespace nacre
