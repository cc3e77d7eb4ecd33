// SPDX-License-Identifier: Apache-2.0
// cli/wrap_text.h: text broken into lines, and labels made to fit beside one another.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace nacre {

// Lines of at most `width` pixels, broken at spaces and behind underscores; a word that is longer
// has a line to itself. None for empty text.
std::vector<std::string> WrapText(const std::string& text, double size_px, double width);

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

// At `size_px`, or at down to two thirds of it where they are too wide, on up to three lines.
// Where even that is too wide, names are put one above the other, in up to four tiers, and numbers,
// which tell those between them, are left out, as are names that need more.
FittedLabels FitLabels(const std::vector<std::string>& labels, double size_px, double width);

}  // namespace nacre
