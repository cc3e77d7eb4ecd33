// SPDX-License-Identifier: Apache-2.0
// image_io/draw_text.h: lines of text in DejaVu Sans, measured and drawn into pictures.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/picture.h"

namespace nacre {

enum class AlignX : uint8_t { kLeft, kCenter, kRight };
enum class AlignY : uint8_t { kTop, kCenter, kBottom };

// A line of text at (x, y), in pixels from the top left corner.
struct TextItem {
  std::string text;  // UTF-8; drawn after Printable()
  int x = 0;
  int y = 0;
  int size_px = 16;
  AlignX align_x = AlignX::kLeft;  // which point of the text is at (x, y)
  AlignY align_y = AlignY::kTop;   // top and centre refer to capital letters, bottom to descenders
  Rgb8 color = {255, 255, 255};
  bool outline = true;  // a dark outline, which makes text readable on any background
};

// A line without an outline, for a plain background; x, y and size are rounded to whole pixels.
TextItem PlainText(const std::string& text, double x, double y, double size_px, AlignX align_x,
                   const Rgb8& color, AlignY align_y = AlignY::kTop);

// Draws text into width * height RGB pixels of display codes, clipped to them. Throws Error
// (kInternal) if the font is not installed.
void DrawText(std::span<uint8_t> rgb8, int width, int height, const std::vector<TextItem>& items);

// The width of a line in pixels at any size, without the rounding of DrawText. Does not need the
// font to be installed: plots are laid out without it, too. Letters beyond ASCII count as the
// widest digit.
double TextWidth(std::string_view text, double size_px);

// The width of a line in pixels as drawn for PlainText. Drawing rounds the size and each advance to
// whole pixels, which makes lines of small text up to a tenth wider.
double DrawnWidth(std::string_view text, double size_px);

}  // namespace nacre
