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

// A line of text at (x, y), pixels from the top left corner.
struct TextItem {
  std::string text;  // UTF-8; drawn as Printable() has it
  int x = 0;
  int y = 0;
  int size_px = 16;
  AlignX align_x = AlignX::kLeft;  // which point of the text (x, y) is
  AlignY align_y = AlignY::kTop;   // top and centre of capital letters, bottom of descenders
  Rgb8 color = {255, 255, 255};
  bool outline = true;  // a dark one, which reads on any background
};

// A line without an outline, for a plain ground; numbers are rounded to whole pixels.
TextItem PlainText(const std::string& text, double x, double y, double size_px, AlignX align_x,
                   const Rgb8& color, AlignY align_y = AlignY::kTop);

// Draws text into width * height RGB pixels of display codes; what lies outside is cut off. Throws
// Error (kInternal) if the font is not installed.
void DrawText(std::span<uint8_t> rgb8, int width, int height, const std::vector<TextItem>& items);

// Width in pixels of a line at any size, without the rounding that drawing does, and without the
// font's file: plots are laid out where no font is installed, too. Letters beyond ASCII count as
// the widest digit.
double TextWidth(std::string_view text, double size_px);

// Width in pixels of a line as PlainText has it drawn: the size and each letter's advance are whole
// pixels, which for small sizes makes lines up to a tenth wider.
double DrawnWidth(std::string_view text, double size_px);

}  // namespace nacre
