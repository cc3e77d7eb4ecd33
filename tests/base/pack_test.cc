// SPDX-License-Identifier: Apache-2.0
// tests/base/pack_test.cc: base/pack-inl.h on every target, of every set of eight lanes.
#include <vector>

#include "base/pack_kernel.h"
#include "catch.h"
#include "targets.h"

namespace nacre {
namespace {

// Every set of eight lanes, beside others.
TEST_CASE("lanes that are packed come back to their places") {
  std::vector<float> x, packed, unpacked;
  for (int i = 0; i < 8 * 256; ++i) {
    const int set = i / 8;
    const bool keep = (set >> (i % 8) & 1) != 0;
    const auto number = static_cast<float>(i + 1);
    x.push_back(keep ? number : -number);
    unpacked.push_back(keep ? number : 0.0f);
    if (keep) packed.push_back(number);
  }
  ForEachTarget([&](Target) {
    const PackedNumbers got = PackAndUnpack(x);
    CHECK(got.packed == packed);
    CHECK(got.unpacked == unpacked);
  });
}

}  // namespace
}  // namespace nacre
