// SPDX-License-Identifier: Apache-2.0
// report/layout.h: the layout of a plot: the ranges of numbers that it shows, and free space for
// text.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "report/figure.h"

namespace nacre {

// ---- Ranges -------------------------------------------------------------------------------------

// low < high; both are above 0 if the axis is logarithmic.
struct AxisRange {
  double low = 0, high = 1;
};

enum class Which : uint8_t { kX, kY };

// The range that the axis sets, or, for ends that it does not set, that of the curves, extended to
// round numbers.
AxisRange RangeOf(const Plot& plot, Which which);

// The position of a value on its axis: 0 at range.low, 1 at range.high.
double PlaceOf(double value, const Axis& axis, const AxisRange& range);

// For a logarithmic axis: whether ticks at powers of ten suffice.
bool IsManyDecades(const AxisRange& range);

// The smallest of 1, 2 and 5 times a power of ten that is at least `step`, which is above 0.
double NiceStep(double step);

// Calls call() with points along the curves, at most a fiftieth of the plot's width apart, in [0,
// 1]^2, with (0, 0) in the lower left corner.
void ForEachPlottedPoint(const Plot& plot, const std::function<void(double x, double y)>& call);

// ---- Free space ---------------------------------------------------------------------------------

// A rectangle in a plot, with (0, 0) in its lower left corner and (1, 1) in its upper right one.
struct PlotBox {
  double x0 = 0, y0 = 0, x1 = 1, y1 = 1;
};

// Which parts of a plot are occupied. Its size in pixels includes axes and their labels.
class PlotLayout {
 public:
  PlotLayout(const Plot& plot, int width, int height);

  // The size of a line of text relative to the plot; glyphs are counted, not bytes.
  double TextWidth(const std::string& text) const;
  double LineHeight() const;

  bool IsFree(const PlotBox& box) const;
  void Occupy(const PlotBox& box);

  // The free box of this size that is nearest to a corner, preferably at the top; nullopt if there
  // is none.
  std::optional<PlotBox> FindRoom(double width, double height) const;

 private:
  double inner_width_, inner_height_;  // in pixels, between the axes
  std::vector<std::pair<double, double>> points_;
  std::vector<PlotBox> boxes_;
};

// A free place for a label of this width beside the vertical line at `x`, searched from the top, or
// above the horizontal line at `y`, searched from the right; if there is none, the first place.
PlotBox RoomBesideColumn(const PlotLayout& layout, double x, double width);
PlotBox RoomAboveRow(const PlotLayout& layout, double y, double width);

// The curves' titles shortened to fit the legend of a plot with this width in pixels. If one is too
// wide, all lose the parts that they share, and those still too wide lose their middle, because the
// ends of titles distinguish curves of one material.
std::vector<std::string> KeyTitles(const Plot& plot, int width);

// A free place for the legend between the curves; nullopt: it must be outside.
std::optional<PlotBox> FindKeyRoom(const Plot& plot, const PlotLayout& layout);

}  // namespace nacre
