// SPDX-License-Identifier: Apache-2.0
// tests/sampling/pair_sampler_test.cc: the points of lights and lobes, pixel by pixel.
#include "sampling/pair_sampler.h"

#include "catch.h"

namespace nacre {
namespace {

TEST_CASE("pairs of points are a net of every pixel") {
  // Of 16 points of a scrambled (0,2)-sequence each sixteenth of either axis holds one.
  const PairSampler sampler = MakePairSampler(16, 9, 7);
  SampleNumbers numbers(16);
  AlignedArray<uint32_t> entries(16);
  for (const uint64_t pixel : {uint64_t{1}, uint64_t{0x123456789abcdef0}}) {
    for (uint32_t i = 0; i < 16; ++i) {
      numbers.number[i] = entries[i] = i;
      numbers.pixel[i] = 0;
    }
    numbers.pixel_count = 1;
    numbers.seeds[0] = pixel;
    uint32_t last_shift = 0;
    for (size_t pair = 0; pair < 9; ++pair) {
      UnitPoints points(16);
      SamplePair(sampler, pair, numbers, entries.data(), 16, &points);
      const AlignedArray<float>&u = points.u, &v = points.v;
      uint32_t in_u = 0, in_v = 0;
      for (size_t i = 0; i < 16; ++i) {
        REQUIRE((u[i] >= 0 && u[i] < 1 && v[i] >= 0 && v[i] < 1));
        in_u |= 1u << static_cast<int>(u[i] * 16);
        in_v |= 1u << static_cast<int>(v[i] * 16);
      }
      CHECK(in_u == 0xffffu);
      CHECK(in_v == 0xffffu);
      // The shifts of a pixel differ from pair to pair.
      const uint32_t shift = points.u_bits[0] ^ sampler.u_bits[pair * 16];
      CHECK(shift != last_shift);
      last_shift = shift;
    }
  }
}

}  // namespace
}  // namespace nacre
