// SPDX-License-Identifier: Apache-2.0
// image_io/png_reader.h: reads PNG files with libspng.
#pragma once

#include <string>

#include "image_io/image_file.h"

namespace nacre {

// Opens any PNG file; channels Y, Y A, R G B or R G B A, for palettes those of their colours.
// EXIF's orientation is honoured. Besides the caller's samples, reading takes memory for two rows,
// or for the whole image in the file's own type if it is interlaced. Throws Error (kBadInput) for
// broken files.
//
// Metadata: texts (tEXt, zTXt, iTXt) under their keywords, those that are not nacre's own as
// "png:KEYWORD"; "gamma" (gAMA: the encoding exponent), "primaries" (cHRM), "icc_profile" (iCCP:
// its name, or "sRGB"), "srgb_intent", "code_points" (cICP); and "not_srgb", which says in words
// how these contradict sRGB.
ImageFile OpenPng(const std::string& path);

}  // namespace nacre
