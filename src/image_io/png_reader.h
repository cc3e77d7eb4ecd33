// SPDX-License-Identifier: Apache-2.0
// image_io/png_reader.h: PNG files, read with libspng.
#pragma once

#include <string>

#include "image_io/image_file.h"

namespace nacre {

// Any PNG file; channels Y, Y A, R G B or R G B A, of palettes those of their colours. EXIF's
// orientation is honoured. Beside the caller's samples, reading takes two rows, or of an interlaced
// file the whole image in the file's own type. Throws Error (kBadInput) for broken files.
//
// Metadata: texts (tEXt, zTXt, iTXt) under their keywords, those that are not nacre's own as
// "png:KEYWORD"; "gamma" (of gAMA, the encoding's exponent),
// "primaries" (of cHRM), "icc_profile" (of iCCP, its name or "sRGB"), "srgb_intent", "code_points"
// (of cICP); "not_srgb" says in words what of them contradicts sRGB.
ImageFile OpenPng(const std::string& path);

}  // namespace nacre
