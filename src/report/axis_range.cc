// SPDX-License-Identifier: Apache-2.0
#include "report/axis_range.h"

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

bool IsShown(double value, const Axis& axis) {
  return std::isfinite(value) && (!axis.log || value > 0);
}

// The range of the data; low > high if there is none.
Range DataRange(const Plot& plot, Which which) {
  const Axis& axis = which == Which::kX ? plot.x : plot.y;
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Curve& curve : plot.curves) {
    for (const double value : which == Which::kX ? curve.x : curve.y) {
      if (!IsShown(value, axis)) continue;
      range.low = std::min(range.low, value);
      range.high = std::max(range.high, value);
    }
  }
  return range;
}

constexpr double kRounding = 1e-9;  // of a step: a value on a tick must stay on it

// Extends the range to the next ticks.
Range RoundLinear(const Range& range) {
  const double step = NiceStep((range.high - range.low) / 8);
  return {step * std::floor(range.low / step + kRounding),
          step * std::ceil(range.high / step - kRounding)};
}

// Extends the range to 1, 2 or 5 times a power of ten, or, if it has many decades, to whole
// decades.
Range RoundLogarithmic(const Range& range) {
  if (IsManyDecades(range)) {
    return {std::pow(10, std::floor(std::log10(range.low) + kRounding)),
            std::pow(10, std::ceil(std::log10(range.high) - kRounding))};
  }
  // The largest such number up to x is 10 over the smallest one from 10 / x on.
  return {10 / NiceStep(10 / range.low), NiceStep(range.high)};
}

}  // namespace

double PlaceOf(double value, const Axis& axis, const Range& range) {
  if (!axis.log) return (value - range.low) / (range.high - range.low);
  return std::log(value / range.low) / std::log(range.high / range.low);
}

Range RangeOf(const Plot& plot, Which which) {
  const Axis& axis = which == Which::kX ? plot.x : plot.y;
  Range range = DataRange(plot, which);
  if (!(range.low <= range.high)) range = {1, 10};  // nothing to show
  if (range.low == range.high) {
    range = axis.log ? Range{range.low / 10, range.low * 10} : Range{range.low - 1, range.low + 1};
  }
  range = axis.log ? RoundLogarithmic(range) : RoundLinear(range);
  if (std::isfinite(axis.low)) range.low = axis.low;
  if (std::isfinite(axis.high)) range.high = axis.high;
  // If only one end is set and the data is beyond it, the other end is chosen past it.
  if (!(range.low < range.high)) range.high = axis.log ? 10 * range.low : range.low + 1;
  return range;
}

bool IsManyDecades(const Range& range) { return range.high > 300 * range.low; }

double NiceStep(double step) {
  const double decade = std::pow(10, std::floor(std::log10(step)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * decade >= step * (1 - 1e-9)) return digit * decade;
  }
  return 10 * decade;
}

void ForEachPlottedPoint(const Plot& plot, const std::function<void(double x, double y)>& call) {
  constexpr double kSpacing = 0.02;
  const Range x_range = RangeOf(plot, Which::kX);
  const Range y_range = RangeOf(plot, Which::kY);
  for (const Curve& curve : plot.curves) {
    double last_x = kFromData;
    double last_y = kFromData;
    for (size_t i = 0; i < curve.x.size(); ++i) {
      if (!IsShown(curve.x[i], plot.x) || !IsShown(curve.y[i], plot.y)) {
        last_x = last_y = kFromData;
        continue;
      }
      const double x = PlaceOf(curve.x[i], plot.x, x_range);
      const double y = PlaceOf(curve.y[i], plot.y, y_range);
      const double length = std::max(std::abs(x - last_x), std::abs(y - last_y));
      const bool joined = length > 0 && curve.style != CurveStyle::kMarks;
      const int steps = joined ? static_cast<int>(std::min(std::ceil(length / kSpacing), 1e3)) : 1;
      for (int step = 1; step < steps; ++step) {
        const double t = static_cast<double>(step) / steps;
        call(last_x + t * (x - last_x), last_y + t * (y - last_y));
      }
      call(x, y);
      last_x = x;
      last_y = y;
    }
  }
}

}  // namespace nacre
