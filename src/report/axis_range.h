// SPDX-License-Identifier: Apache-2.0
// report/axis_range.h: what part of the numbers a plot shows.
#pragma once

#include <functional>

#include "report/plot.h"

namespace nacre {

// low < high; above 0 where the axis is logarithmic.
struct Range {
  double low = 0, high = 1;
};

enum class Which : uint8_t { kX, kY };

// What the axis is told to show, and where it is not told, what the curves have, out to round
// numbers.
Range RangeOf(const Plot& plot, Which which);

// Where a value lies on its axis: 0 at range.low, 1 at range.high.
double PlaceOf(double value, const Axis& axis, const Range& range);

// Of a logarithmic axis: powers of ten are ticks enough.
bool IsManyDecades(const Range& range);

// The smallest of 1, 2 and 5 times a power of ten that is at least `step`, which is above 0.
double NiceStep(double step);

// Calls with points along the curves, at most a fiftieth of the plot's width apart, in [0, 1]^2:
// (0, 0) is the lower left corner.
void ForEachPlottedPoint(const Plot& plot, const std::function<void(double x, double y)>& call);

}  // namespace nacre
