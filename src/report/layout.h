// SPDX-License-Identifier: Apache-2.0
// report/layout.h: where on a plot there is room for words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/plot.h"

namespace nacre {

// A place on a plot: (0, 0) is its lower left corner, (1, 1) its upper right one.
struct PlotBox {
  double x0 = 0, y0 = 0, x1 = 1, y1 = 1;
};

// Which parts of a plot of so many pixels (axes and their labels included) are taken.
class PlotLayout {
 public:
  PlotLayout(const Plot& plot, int width, int height);

  // How much of the plot a line of text takes; glyphs are counted, not bytes.
  double TextWidth(const std::string& text) const;
  double LineHeight() const;

  bool IsFree(const PlotBox& box) const;
  void Occupy(const PlotBox& box);

  // The free box of this size nearest to a corner, those at the top first; or none.
  std::optional<PlotBox> FindRoom(double width, double height) const;

 private:
  double inner_width_, inner_height_;  // pixels between the axes
  std::vector<std::pair<double, double>> points_;
  std::vector<PlotBox> boxes_;
};

// Where a word of this width has room beside the vertical line at `x`, from the top down, or above
// the horizontal line at `y`, from the right; if nowhere, at the first of these places.
PlotBox RoomBesideColumn(const PlotLayout& layout, double x, double width);
PlotBox RoomAboveRow(const PlotLayout& layout, double y, double width);

// The curves' titles as the key of a plot so many pixels wide has room for. Where one is too wide,
// all leave out what they share, and what is still too wide loses its middle: the ends of titles
// tell curves of a material apart.
std::vector<std::string> KeyTitles(const Plot& plot, int width);

// Where the key of the curves' titles has room between them; none: only outside.
std::optional<PlotBox> FindKeyRoom(const Plot& plot, const PlotLayout& layout);

}  // namespace nacre
