// SPDX-License-Identifier: Apache-2.0
// shading/golden.h: minima of functions of one variable, without derivatives and deterministic.
#pragma once

#include <cmath>

namespace nacre {

// Golden-section search in [low, high] for a function with one minimum there, to about the square
// root of the rounding of its values: 48 steps shorten the interval by 1e10.
template <class Function>
double GoldenMinimum(const Function& f, double low, double high) {
  constexpr int kSteps = 48;
  constexpr double kRatio = 0.6180339887498949;  // (sqrt(5) - 1) / 2
  double x1 = high - kRatio * (high - low);
  double x2 = low + kRatio * (high - low);
  double f1 = f(x1);
  double f2 = f(x2);
  for (int i = 0; i < kSteps; ++i) {
    if (f1 <= f2) {
      high = x2;
      x2 = x1;
      f2 = f1;
      x1 = high - kRatio * (high - low);
      f1 = f(x1);
    } else {
      low = x1;
      x1 = x2;
      f1 = f2;
      x2 = low + kRatio * (high - low);
      f2 = f(x2);
    }
  }
  // A monotonic function has its minimum at one of the ends.
  const double middle = (low + high) / 2;
  const double f_middle = f(middle);
  if (f(low) <= f_middle) return low;
  return f(high) < f_middle ? high : middle;
}

// Finds the lowest of `intervals` + 1 evenly spaced values, and then runs GoldenMinimum around it.
// For functions that may have several minima.
template <class Function>
double ScannedMinimum(const Function& f, double low, double high, int intervals) {
  const double step = (high - low) / intervals;
  int best = 0;
  double least = f(low);
  for (int i = 1; i <= intervals; ++i) {
    const double value = f(low + i * step);
    if (value < least) {
      least = value;
      best = i;
    }
  }
  return GoldenMinimum(f, low + std::fmax(best - 1, 0) * step,
                       low + std::fmin(best + 1, intervals) * step);
}

}  // namespace nacre
