// SPDX-License-Identifier: Apache-2.0
// image_io/oiio.h: OpenImageIO, loaded when first used.
//
// It is in a module of its own, nacre_oiio.so, which is looked for beside the file that this code
// is in, program or libnacre.so, and where it is installed as seen from that file: ../lib/nacre
// from a program, nacre/ from the library. Not in the working folder, nor by anything in the
// environment.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "image_io/image_file.h"

namespace nacre {

// PNG, JPEG, TIFF, PNM and TGA; as OpenImage says. First page, full resolution. Rows are decoded in
// bands: beside the caller's samples, reading takes memory for a band, and whatever OpenImageIO and
// the format's library do, an interlaced or progressive image once in the file's own type.
// Orientation tags are honoured. JPEG files that end before their pixels are refused.
ImageFile OpenWithOiio(const std::string& path);

enum class AlignX : uint8_t { kLeft, kCenter, kRight };
enum class AlignY : uint8_t { kTop, kCenter, kBottom };

// A line of text at (x, y), pixels from the top left corner.
struct TextItem {
  std::string text;  // drawn as Printable() has it
  int x = 0;
  int y = 0;
  int size_px = 16;
  AlignX align_x = AlignX::kLeft;  // which point of the text (x, y) is
  AlignY align_y = AlignY::kTop;   // top and centre of capital letters, bottom of descenders
  std::array<uint8_t, 3> color = {255, 255, 255};
  bool outline = true;  // a dark one, which reads on any background
};

// Draws text in DejaVu Sans into width * height RGB pixels of display codes. Throws Error
// (kInternal) if the module or a font is missing.
void DrawText(std::span<uint8_t> rgb8, int width, int height, const std::vector<TextItem>& items);

}  // namespace nacre
