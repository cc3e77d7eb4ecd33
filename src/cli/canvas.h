// SPDX-License-Identifier: Apache-2.0
// cli/canvas.h: a picture of display codes that is put together from others and text.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "image_io/draw_text.h"

namespace nacre {

class Canvas {
 public:
  Canvas(int width, int height, const std::array<uint8_t, 3>& ground);

  // Copies RGB rows of `width` pixels to (left, top); what lies outside is cut off.
  void Paste(const std::vector<uint8_t>& rgb8, int width, int left, int top);

  // Text is drawn by DrawText, all of it at once.
  void Write(const std::string& text, double x, double y, double size_px, AlignX align,
             const std::array<uint8_t, 3>& ink);
  void AddText(const std::vector<TextItem>& items);
  void DrawText();

  // The file appears whole or not at all. Throws Error (kCannotWrite).
  void WritePng(const std::string& path, bool small) const;

 private:
  int width_, height_;
  std::vector<uint8_t> rgb8_;
  std::vector<TextItem> text_;
};

}  // namespace nacre
