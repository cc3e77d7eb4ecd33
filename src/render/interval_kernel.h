// SPDX-License-Identifier: Apache-2.0
// render/interval_kernel.h: MeasureSpread of interval.h for blocks of pixels, in SIMD, with the
// same bits on every target.
#pragma once

#include <cstdint>

#include "render/adaptive_plan.h"
#include "render/interval.h"

namespace nacre {

inline constexpr int kBlockSide = 4;
inline constexpr size_t kBlockPixels = size_t{kBlockSide} * kBlockSide;

// The confidence intervals of a block's pixels.
struct BlockIntervals {
  uint32_t narrow;  // pixels, as bits, whose half-width is within the tolerance in every channel
  double half_width[kBlockPixels];  // largest of the channels
  double tolerance[kBlockPixels];   // smallest of the channels
};

// `sums` are those of the block's samples, by replicate and channel. `samples` is, by pixel, the
// number of samples of each replicate; 0 gives an undefined interval. NaN is never within the
// tolerance.
void MeasureBlock(const double* const (&sums)[kReplicates][3], const uint32_t* samples,
                  const ErrorBound& error, BlockIntervals* intervals);

}  // namespace nacre
