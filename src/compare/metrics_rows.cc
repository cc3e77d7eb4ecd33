// SPDX-License-Identifier: Apache-2.0
#include "compare/metrics_rows.h"

#include <algorithm>
#include <functional>
#include <limits>

#include "compare/layers.h"

namespace nacre {

void LargestErrors::DropSmaller() {
  const auto last = errors_.begin() + static_cast<std::ptrdiff_t>(kept_ - 1);
  std::nth_element(errors_.begin(), last, errors_.end(), std::greater<>());
  threshold_ = *last;
  errors_.resize(kept_);
}

void ErrorSums::Add(const ErrorSums& other) {
  finite += other.finite;
  relative += other.relative;
  zero_mismatches += other.zero_mismatches;
  squares += other.squares;
  softened_squares += other.softened_squares;
  sum_got += other.sum_got;
  sum_reference += other.sum_reference;
  largest = std::max(largest, other.largest);
  peak = std::max(peak, other.peak);
  largest_relative = std::max(largest_relative, other.largest_relative);
}

double SoftenedSquare(double error, double reference) {
  return error * error / (reference * reference + kDarkReference * kDarkReference);
}

float RelativeToFloat(double relative) {
  constexpr double kMost = std::numeric_limits<float>::max();
  return static_cast<float>(std::min(relative, kMost));
}

}  // namespace nacre
