// SPDX-License-Identifier: Apache-2.0
// image_io/tga_reader.h: reads Truevision TGA files.
#pragma once

#include <string>

#include "image_io/image_file.h"

namespace nacre {

// Opens files with palettes, colours of 15, 16, 24 and 32 bits, or greys of 8 bits; uncompressed or
// run-length encoded, starting at any corner (Truevision TGA File Format Specification, version
// 2.0). Channels Y, R G B or R G B A, with alpha if the descriptor counts alpha bits. Display
// values.
//
// Throws Error (kBadInput) for other kinds and for broken files. This reader exists because
// OpenImageIO 2.4 reads out of bounds where an index is beyond the palette, and Debian has no other
// library for the format that is made for untrusted files.
ImageFile OpenTga(const std::string& path);

}  // namespace nacre
