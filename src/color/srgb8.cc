// SPDX-License-Identifier: Apache-2.0
#include "color/srgb8.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "color/transfer.h"

namespace nacre {
namespace {

// The bits of the smallest float whose code is at least `code`, relative to kFirstBits. Double is
// accurate enough: that a real threshold lies within its error of a float has a probability of one
// in a billion, and a test would show it.
uint32_t ThresholdOffset(uint32_t code) {
  const double exact = SrgbEotf((code - 0.5) / 255);
  float threshold = static_cast<float>(exact);
  if (threshold < exact) {
    threshold = std::nextafter(threshold, std::numeric_limits<float>::infinity());
  }
  return std::bit_cast<uint32_t>(threshold) - Srgb8Table::kFirstBits;
}

Srgb8Table MakeSrgb8Table() {
  Srgb8Table table;
  uint32_t code = 0;
  uint32_t next = ThresholdOffset(1);  // for code + 1; for 256 it lies beyond the last bucket
  for (uint32_t bucket = 0; bucket < Srgb8Table::kBuckets; ++bucket) {
    const uint32_t end = (bucket + 1) << 16;
    uint32_t entry = code << 16;
    if (next < end) {
      entry += end - next;
      ++code;
      next = ThresholdOffset(code + 1);
    }
    table.entries[bucket] = static_cast<int32_t>(entry);
  }
  return table;
}

}  // namespace

const Srgb8Table& GetSrgb8Table() {
  static const Srgb8Table table = MakeSrgb8Table();
  return table;
}

uint8_t Srgb8(float linear) {
  constexpr float kFirst = std::bit_cast<float>(Srgb8Table::kFirstBits);
  constexpr float kLast = std::bit_cast<float>(Srgb8Table::kLastBits);
  const float clamped = std::min(linear > kFirst ? linear : kFirst, kLast);
  const uint32_t offset = std::bit_cast<uint32_t>(clamped) - Srgb8Table::kFirstBits;
  const auto entry = static_cast<uint32_t>(GetSrgb8Table().entries[offset >> 16]);
  return static_cast<uint8_t>((entry + (offset & 0xffffu)) >> 16);
}

}  // namespace nacre
