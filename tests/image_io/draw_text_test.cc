// SPDX-License-Identifier: Apache-2.0
// tests/image_io/draw_text_test.cc: lines are as wide as they are measured.
#include "image_io/draw_text.h"

#include <algorithm>
#include <string>
#include <vector>

#include "catch.h"

namespace nacre {
namespace {

struct Columns {
  int first, last;
};

// The first and the last column with ink of a line that starts near column 10.
Columns InkedColumns(const std::string& text, double size_px) {
  constexpr int kWidth = 4000, kHeight = 100;
  Columns columns{kWidth, -1};
  std::vector<uint8_t> rgb8(size_t{3} * kWidth * kHeight, 0);
  const TextItem line = PlainText(text, 10, 20, size_px, AlignX::kLeft, {255, 255, 255});
  DrawText(rgb8, kWidth, kHeight, {line});
  for (int x = 0; x < kWidth; ++x) {
    for (int y = 0; y < kHeight; ++y) {
      if (rgb8[3 * static_cast<size_t>(y * kWidth + x)] == 0) continue;
      columns.first = std::min(columns.first, x);
      columns.last = x;
    }
  }
  return columns;
}

// From the ink of a bar in front of the text to that of a bar behind it.
double WidthBetweenBars(const std::string& text, double size_px) {
  const Columns bar = InkedColumns("|", size_px), all = InkedColumns("|" + text + "|", size_px);
  return all.last - all.first - (bar.last - bar.first) - DrawnWidth("|", size_px);
}

TEST_CASE("Lines are drawn as wide as they are measured, letter by letter", "[draw_text]") {
  std::string letters;
  for (char c = ' '; c < 127; ++c) letters += c;
  for (const double size : {5.0, 8.4, 9.0, 10.0, 16.0, 20.0, 27.0, 33.5, 48.0}) {
    INFO("size " << size);
    CHECK(WidthBetweenBars(letters, size) == DrawnWidth(letters, size));
    for (const char* const text : {"WWWWWWWWWW", "roughness 0.25", "TTTT....''''"}) {
      CHECK(WidthBetweenBars(text, size) == DrawnWidth(text, size));
    }
  }
}

TEST_CASE("Letters beyond ASCII, and what the font lacks, are measured as drawn", "[draw_text]") {
  for (const char* const text : {"Größe", "émaillé", "латунь", "ШЩЖ", "‰‱", "…", "漆"}) {
    for (const double size : {6.0, 11.0, 24.0}) {
      INFO(text << " at " << size);
      CHECK(WidthBetweenBars(text, size) == DrawnWidth(text, size));
    }
  }
}

}  // namespace
}  // namespace nacre
