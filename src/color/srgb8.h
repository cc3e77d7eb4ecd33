// SPDX-License-Identifier: Apache-2.0
// color/srgb8.h: 8-bit sRGB codes of linear floats, by a table that is exact for every float. SIMD
// twin: display_kernel.cc.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace nacre {

// The codes' thresholds lie in [2^-13, 1). Each octave is cut into 128 buckets, addressed by the
// float's own bits; the thresholds are so far apart (at least 1.2 % of their octave, near 1/2)
// that no bucket holds two.
//
// An entry holds (code at the bucket's start) * 2^16, plus, if the bucket holds a threshold,
// 2^16 minus the threshold's low 16 bits. Adding the low 16 bits of x then carries into the code
// exactly when x has reached the threshold.
struct Srgb8Table {
  static constexpr uint32_t kFirstBits = 0x39000000u;  // 2^-13: code 0
  static constexpr uint32_t kLastBits = 0x3f7fffffu;   // the float before 1: code 255
  static constexpr size_t kBuckets = ((kLastBits - kFirstBits) >> 16) + 1;

  std::array<int32_t, kBuckets> entries;
};

// The table, computed in double from the transfer curve at first use.
const Srgb8Table& GetSrgb8Table();

// floor(255 SrgbOetf(x) + 1/2) with x = `linear` clamped to [0, 1]. NaN gives 0.
uint8_t Srgb8(float linear);

}  // namespace nacre
