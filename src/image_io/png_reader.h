// SPDX-License-Identifier: Apache-2.0
// image_io/png_reader.h: plain PNG files without OpenImageIO, whose libraries take 0.2 s to load,
// and what any PNG file says of its colours.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "image_io/image_file.h"

namespace nacre {

// A PNG file of 8 or 16 bits a sample, not interlaced: grey, grey and alpha, colours, colours and
// alpha, or a palette without transparency; channels R G B A or Y A. EXIF's orientation is
// honoured. Metadata as PngColors gives them.
//
// Nothing for any other file, and for one whose chunks are broken: OpenWithOiio (oiio.h) reads or
// refuses it. ImageFile::read throws Error (kBadInput) if the compressed data do not hold the
// pixels; beside the caller's samples it takes two rows, and the file itself is in memory.
std::optional<ImageFile> OpenPlainPng(const std::string& path);

// "gamma" (of gAMA, the encoding's exponent), "primaries" (of cHRM), "icc_profile" (of iCCP, "sRGB"
// or its name), "srgb_intent": those that the file has. "not_srgb" says in words what of them
// contradicts sRGB. Texts (tEXt, zTXt, iTXt) under their keywords, those that are not nacre's own
// under "png:KEYWORD", so that a file's words never stand where a chunk's meaning does. Nothing for
// broken files.
std::map<std::string, std::string> PngColors(const std::string& path);

}  // namespace nacre
