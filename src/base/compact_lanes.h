// SPDX-License-Identifier: Apache-2.0
// base/compact_lanes.h: permutations that move the selected lanes of a vector to its front.
//
// Highway's Compress has such a table of its own below AVX-512, but GCC 12 copies its 2 KiB to the
// stack at every call. CompressStore is no alternative: on Zen 4 the instruction is microcode.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace nacre {

inline constexpr uint32_t kMaxCompactedLanes = 8;

struct LaneOrder {
  uint8_t lanes[kMaxCompactedLanes];
};
using LaneOrders = std::array<LaneOrder, 1 << kMaxCompactedLanes>;

// Indexed by a mask's bits: the selected lanes in ascending order, then the first of them repeated.
inline constexpr LaneOrders kCompactedLanes = [] {
  LaneOrders orders{};
  for (uint32_t bits = 0; bits < orders.size(); ++bits) {
    const int first = bits == 0 ? 0 : std::countr_zero(bits);
    for (uint8_t& lane : orders[bits].lanes) lane = static_cast<uint8_t>(first);
    size_t count = 0;
    for (uint8_t lane = 0; lane < kMaxCompactedLanes; ++lane) {
      if ((bits >> lane & 1) != 0) orders[bits].lanes[count++] = lane;
    }
  }
  return orders;
}();

}  // namespace nacre
