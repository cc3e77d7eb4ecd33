// SPDX-License-Identifier: Apache-2.0
// render/interval_kernel.h: MeasureSpread of interval.h for whole blocks of pixels, in SIMD, the
// same bits on every target.
#pragma once

#include <cstdint>

#include "render/adaptive_plan.h"
#include "render/interval.h"

namespace nacre {

inline constexpr int kBlockSide = 4;
inline constexpr size_t kBlockPixels = size_t{kBlockSide} * kBlockSide;

// What is known of the errors of a block's pixels.
struct BlockIntervals {
  uint32_t narrow;  // pixels, as bits, whose interval is as narrow as wanted, in every channel
  double half_width[kBlockPixels];  // of the widest channel
  double wanted[kBlockPixels];      // of the strictest
};

// `sums`: the block's sums of samples in each replicate, by channel; `samples`: how many a pixel
// took in each replicate, where 0 gives undefined intervals. NaN is never narrow.
void MeasureBlock(const double* const (&sums)[kReplicates][3], const uint32_t* samples,
                  const WantedError& error, BlockIntervals* intervals);

}  // namespace nacre
