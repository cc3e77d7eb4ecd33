// SPDX-License-Identifier: Apache-2.0
// image_io/half.h: converts floats to the 16-bit halves of EXR.
#pragma once

#include <cstddef>
#include <cstdint>

namespace nacre {

// The largest finite half. Larger samples are clamped to it, and counted.
inline constexpr float kMaxHalf = 65504.0f;

// Counts of samples that a file does not hold exactly, or that are not finite.
struct SampleCounts {
  uint64_t clamped = 0;   // finite, but beyond +-kMaxHalf in half channels: stored as +-kMaxHalf
  uint64_t infinite = 0;  // stored as +-kMaxHalf in half channels, unchanged in float channels
  uint64_t nan = 0;       // stored as NaN

  SampleCounts& operator+=(const SampleCounts& other) {
    clamped += other.clamped;
    infinite += other.infinite;
    nan += other.nan;
    return *this;
  }
};

// Rounds to the nearest half, ties to even, and clamps to +-kMaxHalf. NaN becomes 0x7e00 with its
// sign. The bits do not depend on the SIMD target, nor on whether denormals are flushed.
SampleCounts FloatToHalf(const float* in, size_t count, uint16_t* out);

// Counts infinities and NaN.
SampleCounts CountNonfinite(const float* in, size_t count);

}  // namespace nacre
