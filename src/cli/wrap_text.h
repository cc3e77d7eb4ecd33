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
  };
  double size = 0;            // of the text, px
  double lines = 0;           // of the label that has most
  std::vector<Label> labels;  // of every place, or of some, first and last among them
};

// At `size_px`, or at down to two thirds of it where they are too wide, on up to three lines.
// Where even that is too wide, labels are left out.
FittedLabels FitLabels(const std::vector<std::string>& labels, double size_px, double width);

}  // namespace nacre
