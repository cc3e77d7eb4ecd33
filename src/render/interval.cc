// SPDX-License-Identifier: Apache-2.0
#include "render/interval.h"

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

// The most by which samples of a pixel on an outline may differ from `mean`: as much as those on
// the block's outlines that hit, as the background if it may be seen, or as black does.
double Contrast(const PixelRange& range, const double* background, double mean) {
  const double to_background = background != nullptr ? std::abs(*background - mean) : 0;
  return std::max({range.high - mean, mean - range.low, to_background, std::abs(mean), kDarkest});
}

}  // namespace

Measured MeasureSpread(const double (&values)[kReplicates]) {
  double mean = 0, squares = 0;
  for (const double value : values) mean += value;
  mean *= 1.0 / kReplicates;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, kOfSquares * squares};
}

Measured MeasureOnOutline(const double (&values)[kReplicates], const PixelRange& range,
                          const double* background, double samples) {
  Measured measured = MeasureSpread(values);
  const double least = Contrast(range, background, measured.mean) / samples;
  measured.half_width2 = std::max(measured.half_width2, least * least);
  return measured;
}

Measured MeasureCovered(const double (&values)[kReplicates], const double (&hits)[kReplicates],
                        double covered, const PixelRange& range, double background,
                        double samples) {
  double all_hits = 0, excess = 0;
  for (size_t r = 0; r < kReplicates; ++r) {
    all_hits += hits[r];
    excess += values[r] - background;
  }
  if (all_hits == 0) {
    const double least = covered * Contrast(range, nullptr, background);
    return {background, least * least};
  }
  const double of_hit = excess / all_hits;
  double corrected[kReplicates];
  for (size_t r = 0; r < kReplicates; ++r) corrected[r] = values[r] - of_hit * (hits[r] - covered);
  Measured measured = MeasureSpread(corrected);
  // Nothing is known of a spread from one hit, or where the range's samples all missed.
  const double hit_count = all_hits * samples / kReplicates;
  const bool is_known = range.low < range.high || (range.low == range.high && hit_count > 1);
  const double spread = is_known ? range.high - range.low : std::abs(of_hit);
  const double least = covered * spread / hit_count;
  measured.half_width2 = std::max(measured.half_width2, least * least);
  return measured;
}

}  // namespace nacre
