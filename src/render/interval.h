// SPDX-License-Identifier: Apache-2.0
// render/interval.h: confidence intervals: the mean of one channel of a pixel, and the 95 %
// interval around it, from the spread of the pixel's replicates.
#pragma once

#include <algorithm>
#include <cmath>

#include "render/adaptive_plan.h"

namespace nacre {

// Errors are relative to a pixel's value or, if that is lower, to this value, which a display shows
// as near black.
inline constexpr double kDarkest = 0.05;

// The largest error that a pixel may have: `max_error` times its value, which is clamped to at
// least kDarkest and at most `white` (WhiteLevel). Highlights may be a thousand times brighter than
// white, and errors relative to them, in a few pixels, would dominate the error of the picture.
struct ErrorBound {
  double max_error;
  double white;
};

inline double ToleranceAt(const ErrorBound& error, double mean) {
  return error.max_error * std::max(std::min(std::abs(mean), error.white), kDarkest);
}

struct PixelRange {
  double low, high;  // empty if low > high
};

struct Interval {
  double mean;
  double half_width2;  // squared half-width
};

// Measures the interval from the mean of each replicate's samples.
Interval MeasureSpread(const double (&values)[kReplicates]);

// Measures the interval of a pixel that an outline crosses. All `samples` of the pixel may miss a
// sliver, or the replicates may have equally many hits by chance, so that they agree. So the
// half-width is at least the effect of one more sample that differs from the mean as much as any in
// `range`, as the background or as black. `range` is that of the samples that hit, in outline
// pixels of the block. `background` is null if it is not visible in the pixel.
Interval MeasureOnOutline(const double (&values)[kReplicates], const PixelRange& range,
                          const double* background, double samples);

// Measures the interval of a pixel of known coverage, `covered`. `hits` is the share of each
// replicate's samples that hit. Only the mean of the hits has an error then: the replicates' values
// are corrected for the difference between their shares of hits and the coverage. Few hits may
// agree by chance, too: the half-width is at least `covered` times the n-th part of the range for n
// hits; and a single hit says nothing about others.
Interval MeasureCovered(const double (&values)[kReplicates], const double (&hits)[kReplicates],
                        double covered, const PixelRange& range, double background, double samples);

}  // namespace nacre
