// SPDX-License-Identifier: Apache-2.0
// image_io/jpeg_reader.h: reads JPEG files with libjpeg-turbo.
#pragma once

#include <string>

#include "image_io/image_file.h"

namespace nacre {

// Opens baseline and progressive files of 8 bits per sample; channels Y or R G B. CMYK is converted
// as Adobe's programs store it. EXIF's orientation is honoured; metadata: "icc_profile" (its name,
// or "sRGB") and "not_srgb" (why not, in words). Besides the caller's samples, reading takes memory
// for a row, or for the coefficients of a progressive file, two bytes each. Throws Error
// (kBadInput) for broken files: pixels that the library would make up are refused.
ImageFile OpenJpeg(const std::string& path);

}  // namespace nacre
