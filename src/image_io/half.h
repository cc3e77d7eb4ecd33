// SPDX-License-Identifier: Apache-2.0
// image_io/half.h: floats to 16-bit halves, as EXR stores them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace nacre {

// What a half cannot hold is held back to this, and counted.
inline constexpr float kMaxHalf = 65504.0f;

// Samples that a file does not hold as they were computed, or that should not exist.
struct SampleCounts {
  uint64_t clamped = 0;   // finite and beyond +-kMaxHalf, in half channels: stored as +-kMaxHalf
  uint64_t infinite = 0;  // in half channels stored as +-kMaxHalf, in float channels as they are
  uint64_t nan = 0;       // stored as NaN

  SampleCounts& operator+=(const SampleCounts& other) {
    clamped += other.clamped;
    infinite += other.infinite;
    nan += other.nan;
    return *this;
  }
};

// Rounds to the nearest half, ties to even, beyond +-kMaxHalf to that. NaN gives 0x7e00 with its
// sign. The bits do not depend on the SIMD target, nor on denormals being flushed.
SampleCounts FloatToHalf(const float* in, size_t count, uint16_t* out);

// Counts infinities and NaN.
SampleCounts CountNonfinite(const float* in, size_t count);

}  // namespace nacre
