// SPDX-License-Identifier: Apache-2.0
// cli/wrap_text.h: text broken into lines, and labels made to fit beside one another.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace nacre {

// Lines of at most `width` pixels, as Printable() has the text, broken at spaces and behind
// underscores, and within a word that is longer than a line. None for empty text.
std::vector<std::string> WrapText(const std::string& text, double size_px, double width);

// A line of at most `width` pixels, as Printable() has the text: what is too long ends in an
// ellipsis.
std::string CutText(const std::string& text, double size_px, double width);

// `count` of the places 0 to last, both included, as evenly as can be; count >= 2.
std::vector<size_t> SpreadPlaces(size_t last, size_t count);

// Labels of places that are `width` pixels apart.
struct FittedLabels {
  struct Label {
    size_t place = 0;
    std::vector<std::string> lines;
    double below = 0;  // lines of other labels between it and what it belongs to
  };
  double size = 0;            // of the text, px
  double lines = 0;           // that all of them take
  std::vector<Label> labels;  // of every place, or of some, first and last among them
};

// Pixels of the page on both sides of all places that labels may take.
struct RoomBeside {
  double left = 0, right = 0;
};

// At `size_px`, or at down to two thirds of it where they are too wide, on up to three lines.
// Where even that is too wide, names are put one above the other, in up to four tiers, and numbers,
// which tell those between them, are left out, as are names that need more.
// What fits nowhere is cut.
FittedLabels FitLabels(const std::vector<std::string>& labels, double size_px, double width,
                       const RoomBeside& beside);

}  // namespace nacre
