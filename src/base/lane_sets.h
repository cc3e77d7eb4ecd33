// SPDX-License-Identifier: Apache-2.0
// base/lane_sets.h: the lanes of each set of up to eight, to permute vectors by.
//
// Below AVX-512 Highway's Compress has such a table of its own, but GCC 12 copies its 2 KiB to the
// stack at every call. Its CompressStore is no way out: on Zen 4 the instruction is microcode.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace nacre {

inline constexpr uint32_t kSetLanes = 8;

struct LaneSet {
  uint8_t lanes[kSetLanes];
};
using LaneSets = std::array<LaneSet, 1 << kSetLanes>;

// By a set's bits: its lanes in their order; then the first of them again.
inline constexpr LaneSets kLanesOfSets = [] {
  LaneSets sets{};
  for (uint32_t bits = 0; bits < sets.size(); ++bits) {
    const int first = bits == 0 ? 0 : std::countr_zero(bits);
    for (uint8_t& lane : sets[bits].lanes) lane = static_cast<uint8_t>(first);
    size_t count = 0;
    for (uint8_t lane = 0; lane < kSetLanes; ++lane) {
      if ((bits >> lane & 1) != 0) sets[bits].lanes[count++] = lane;
    }
  }
  return sets;
}();

}  // namespace nacre
