// SPDX-License-Identifier: Apache-2.0
// report/axis_range.h: the ranges of numbers that a plot shows.
#pragma once

#include <functional>

#include "report/figure.h"

namespace nacre {

// low < high; both are above 0 if the axis is logarithmic.
struct Range {
  double low = 0, high = 1;
};

enum class Which : uint8_t { kX, kY };

// The range that the axis sets, or, for ends that it does not set, that of the curves, extended to
// round numbers.
Range RangeOf(const Plot& plot, Which which);

// The position of a value on its axis: 0 at range.low, 1 at range.high.
double PlaceOf(double value, const Axis& axis, const Range& range);

// For a logarithmic axis: whether ticks at powers of ten suffice.
bool IsManyDecades(const Range& range);

// The smallest of 1, 2 and 5 times a power of ten that is at least `step`, which is above 0.
double NiceStep(double step);

// Calls call() with points along the curves, at most a fiftieth of the plot's width apart, in [0,
// 1]^2, with (0, 0) in the lower left corner.
void ForEachPlottedPoint(const Plot& plot, const std::function<void(double x, double y)>& call);

}  // namespace nacre
