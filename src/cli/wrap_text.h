// SPDX-License-Identifier: Apache-2.0
// cli/wrap_text.h: breaks text into lines, and fits labels beside one another.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace nacre {

// Lines of at most `width` pixels, of the text after Printable(). Breaks at spaces and after
// underscores, and within words that are longer than a line. Empty for empty text.
std::vector<std::string> WrapText(const std::string& text, double size_px, double width);

// The text after Printable(), cut to at most `width` pixels; text that is too long ends in an
// ellipsis.
std::string CutText(const std::string& text, double size_px, double width);

// `count` of the places 0 to last, including both, spaced as evenly as possible; count >= 2.
std::vector<size_t> SpreadPlaces(size_t last, size_t count);

// Labels at places that are `width` pixels apart.
struct FittedLabels {
  struct Label {
    size_t place = 0;
    std::vector<std::string> lines;
    double below = 0;  // how many lines of other labels are between it and its place
  };
  double size = 0;            // text size in pixels
  double lines = 0;           // total height in lines
  std::vector<Label> labels;  // for all places, or for some that include the first and last
};

// The space on the page to the left and right of all places, in pixels, which labels may use.
struct RoomBeside {
  double left = 0, right = 0;
};

// Fits labels at size `size_px`, or, if they are too wide, down to 0.7 of it, on up to three lines.
// If they are still too wide, names are stacked in up to four tiers. Numbers, which can be inferred
// from their neighbours, are left out instead, as are names that need more tiers. Labels that still
// do not fit are cut.
FittedLabels FitLabels(const std::vector<std::string>& labels, double size_px, double width,
                       const RoomBeside& beside);

}  // namespace nacre
