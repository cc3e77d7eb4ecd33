// SPDX-License-Identifier: Apache-2.0
// image_io/tga_reader.h: Truevision TGA files.
#pragma once

#include <string>

#include "image_io/image_file.h"

namespace nacre {

// Palettes, colours of 15, 16, 24 and 32 bits, greys of 8; as they are or in runs, from whichever
// corner (Truevision TGA File Format Specification, version 2.0). Channels Y, R G B or R G B A:
// alpha where the descriptor says that there are bits of it. Display values.
//
// Throws Error (kBadInput) for other and for broken files. Written out because OpenImageIO 2.4
// reads beyond its memory where an index is beyond the palette, and the files have no other library
// in Debian that is made for strangers' files.
ImageFile OpenTga(const std::string& path);

}  // namespace nacre
