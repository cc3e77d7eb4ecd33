// SPDX-License-Identifier: Apache-2.0
#include "render/interval.h"

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

// The sum of the replicates' squared differences from their mean, times this factor, is the square
// of the interval's half-width. 97.5 % of Student's t distribution with three degrees of freedom
// lie below 3.182446305; its square is divided by n (n - 1), n being the number of replicates.
constexpr double kSquaresToHalfWidth2 =
    3.182446305 * 3.182446305 / ((kReplicates - 1) * kReplicates);

// How much samples of an outline pixel may differ from `mean`: as much as those in `range`, as the
// background if it is visible, or as black.
double MaxDifference(const PixelRange& range, const double* background, double mean) {
  const double to_background = background != nullptr ? std::abs(*background - mean) : 0;
  return std::max({range.high - mean, mean - range.low, to_background, std::abs(mean), kDarkest});
}

}  // namespace

Interval MeasureSpread(const double (&values)[kReplicates]) {
  double mean = 0, squares = 0;
  for (const double value : values) mean += value;
  mean *= 1.0 / kReplicates;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, kSquaresToHalfWidth2 * squares};
}

Interval MeasureOnOutline(const double (&values)[kReplicates], const PixelRange& range,
                          const double* background, double samples) {
  Interval interval = MeasureSpread(values);
  const double least = MaxDifference(range, background, interval.mean) / samples;
  interval.half_width2 = std::max(interval.half_width2, least * least);
  return interval;
}

Interval MeasureCovered(const double (&values)[kReplicates], const double (&hits)[kReplicates],
                        double covered, const PixelRange& range, double background,
                        double samples) {
  double all_hits = 0, excess = 0;
  for (size_t r = 0; r < kReplicates; ++r) {
    all_hits += hits[r];
    excess += values[r] - background;
  }
  if (all_hits == 0) {
    const double least = covered * MaxDifference(range, nullptr, background);
    return {background, least * least};
  }
  const double of_hit = excess / all_hits;
  double corrected[kReplicates];
  for (size_t r = 0; r < kReplicates; ++r) corrected[r] = values[r] - of_hit * (hits[r] - covered);
  Interval interval = MeasureSpread(corrected);
  // The range says nothing about the spread if it is empty or is that of a single hit.
  const double hit_count = all_hits * samples / kReplicates;
  const bool is_known = range.low < range.high || (range.low == range.high && hit_count > 1);
  const double spread = is_known ? range.high - range.low : std::abs(of_hit);
  const double least = covered * spread / hit_count;
  interval.half_width2 = std::max(interval.half_width2, least * least);
  return interval;
}

}  // namespace nacre
