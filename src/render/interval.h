// SPDX-License-Identifier: Apache-2.0
// render/interval.h: what a pixel's replicates tell of its error: a channel's mean and the 95 %
// interval around it.
#pragma once

#include <algorithm>
#include <cmath>

#include "render/adaptive_plan.h"

namespace nacre {

// Below this value an error is absolute: what a display shows as near black.
inline constexpr double kDarkest = 0.05;

// The error that is wanted: `max_error` times the value, but of kDarkest at least, and at most of
// `white` (WhiteLevel). Highlights may be a thousand times brighter, and some ten pixels with such
// errors would be nearly all of the picture's.
struct WantedError {
  double max_error;
  double white;
};
inline double Wanted(const WantedError& error, double mean) {
  return error.max_error * std::max(std::min(std::abs(mean), error.white), kDarkest);
}

// Student's t, squared, over the number of sums: 97.5 % of the distribution with three degrees of
// freedom lie below 3.182446305. The sum of the replicates' squared differences from their mean,
// times this, is the square of the interval's half-width.
inline constexpr double kOfSquares = 3.182446305 * 3.182446305 / ((kReplicates - 1) * kReplicates);

struct PixelRange {
  double low, high;  // none if low > high
};

struct Measured {
  double mean;
  double half_width2;  // of the interval, squared
};

// `values`: the mean of each replicate's samples. SIMD twin, for blocks: interval_kernel.h.
Measured MeasureSpread(const double (&values)[kReplicates]);

// A pixel that an outline crosses, of `samples` in all. All may miss a sliver, and then agree; and
// so may the replicates' shares of hits. The interval is never narrower than what one more sample
// might tell that differs from the mean as much as those in `range` (of the outlines around that
// hit), as the background, which is null where it cannot be seen, or as black does.
Measured MeasureOnOutline(const double (&values)[kReplicates], const PixelRange& range,
                          const double* background, double samples);

// The same where it is known what share of the pixel is covered. What is measured is then the mean
// of the samples that hit, `hits` of each replicate's: a share of them that is wrong by chance is
// taken back. Few hits may agree by chance, too: the mean of n is not better than an n-th of the
// range; and one alone tells nothing of the others.
Measured MeasureCovered(const double (&values)[kReplicates], const double (&hits)[kReplicates],
                        double covered, const PixelRange& range, double background, double samples);

}  // namespace nacre
