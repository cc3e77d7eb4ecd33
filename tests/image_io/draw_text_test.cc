// SPDX-License-Identifier: Apache-2.0
// tests/image_io/draw_text_test.cc: lines are as wide as they are measured, in any script.
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

// How wide the strokes of a line are that no empty column parts, from left to right.
std::vector<int> WidthsOfLetters(const std::string& text) {
  constexpr int kWidth = 400, kHeight = 60;
  std::vector<uint8_t> rgb8(size_t{3} * kWidth * kHeight, 0);
  DrawText(rgb8, kWidth, kHeight, {PlainText(text, 10, 8, 32, AlignX::kLeft, {255, 255, 255})});
  std::vector<int> widths;
  bool was_inked = false;
  for (int x = 0; x < kWidth; ++x) {
    bool is_inked = false;
    for (int y = 0; y < kHeight; ++y) {
      is_inked |= rgb8[3 * static_cast<size_t>(y * kWidth + x)] != 0;
    }
    if (is_inked && !was_inked) widths.push_back(0);
    if (is_inked) ++widths.back();
    was_inked = is_inked;
  }
  return widths;
}

TEST_CASE("Hebrew and Arabic are drawn from right to left, their letters joined", "[draw_text]") {
  const auto width = [](const char* letter) {
    const std::vector<int> widths = WidthsOfLetters(letter);
    REQUIRE(widths.size() == 1);
    return widths[0];
  };
  using Widths = std::vector<int>;
  const int shin = width("ש"), vav = width("ו"), l = width("l"), w = width("w");
  REQUIRE(shin > 2 * vav);
  CHECK(WidthsOfLetters("שו") == Widths{vav, shin});
  CHECK(WidthsOfLetters("ושו") == Widths{vav, shin, vav});
  // What is Latin, and numbers, run from left to right wherever they are; the first letter says how
  // the line does.
  const int one = width("1"), four = width("4");
  CHECK(WidthsOfLetters("ש14") == Widths{one, four, shin});
  CHECK(WidthsOfLetters("lwשו") == Widths{l, w, vav, shin});
  CHECK(WidthsOfLetters("שוlw") == Widths{l, w, vav, shin});
  // Beh three times: one stroke, of the forms for the begin, the middle and the end of a word. Lam
  // and alef become one letter.
  CHECK(WidthsOfLetters("ببب").size() == 1);
  CHECK(WidthsOfLetters("ببب") == WidthsOfLetters("\uFE91\uFE92\uFE90"));
  CHECK(WidthsOfLetters("لا") == WidthsOfLetters("\uFEFB"));
  for (const char* const text : {"שלום 12", "مرحبا", "red أحمر 0.25", "لا"}) {
    CHECK(WidthBetweenBars(text, 16) == DrawnWidth(text, 16));
  }
}

}  // namespace
}  // namespace nacre
