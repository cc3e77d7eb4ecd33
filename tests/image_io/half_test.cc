// SPDX-License-Identifier: Apache-2.0
// tests/image_io/half_test.cc: floats to halves on every target, against a table and Imath.
#include "image_io/half.h"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <Imath/half.h>

#include "base/float_mode.h"
#include "tables.h"
#include "targets.h"

namespace nacre {
namespace {

// The half nearest to x where there is one that is finite, by Imath's converter.
uint16_t ImathHalf(float x) { return Imath::half(x).bits(); }

uint16_t OneHalf(float x) {
  uint16_t half = 0;
  FloatToHalf(&x, 1, &half);
  return half;
}

std::vector<float> ManyFloats() {
  std::vector<float> floats;
  std::mt19937 random(1);
  while (floats.size() < 300000) {
    const float x = std::bit_cast<float>(static_cast<uint32_t>(random()));
    if (std::abs(x) <= kMaxHalf) floats.push_back(x);
  }
  // Every half, half-way to the next, and the floats around that.
  for (uint32_t bits = 0; bits < 0x7bff; ++bits) {
    const float low = Imath::half(Imath::half::FromBits, static_cast<uint16_t>(bits));
    const float high = Imath::half(Imath::half::FromBits, static_cast<uint16_t>(bits + 1));
    const float middle = 0.5f * (low + high);
    for (const float x : {low, middle, std::nextafter(middle, low), std::nextafter(middle, high)}) {
      floats.push_back(x);
      floats.push_back(-x);
    }
  }
  return floats;
}

TEST_CASE("halves of the reference table", "[table]") {
  const nlohmann::json table = LoadTable("half_rne");
  ForEachTarget([&](Target) {
    for (const auto& row : table["rows"]) {
      const auto bits = std::stoul(row["f32_bits"].get<std::string>(), nullptr, 16);
      const auto half = std::stoul(row["half_bits"].get<std::string>(), nullptr, 16);
      const float x = std::bit_cast<float>(static_cast<uint32_t>(bits));
      CAPTURE(x);
      // Infinity in the table is what the writer holds back to the largest half.
      const bool infinite = (half & 0x7fff) == 0x7c00;
      CHECK(OneHalf(x) == (infinite ? (half & 0x8000) | 0x7bff : half));
    }
  });
}

TEST_CASE("halves are rounded to nearest even, with denormals flushed or not") {
  const std::vector<float> floats = ManyFloats();
  std::vector<uint16_t> expected;
  for (const float x : floats) expected.push_back(ImathHalf(x));
  ForEachTarget([&](Target) {
    std::vector<uint16_t> halves(floats.size());
    const SampleCounts counts = FloatToHalf(floats.data(), floats.size(), halves.data());
    CHECK(halves == expected);
    CHECK(counts.clamped + counts.infinite + counts.nan == 0);
    const FlushDenormals flush;
    FloatToHalf(floats.data(), floats.size(), halves.data());
    CHECK(halves == expected);
  });
}

TEST_CASE("what a half cannot hold is clamped and counted") {
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float beyond = std::nextafter(kMaxHalf, infinity);
  // At every place of a vector, and in its tail.
  ForEachTarget([&](Target) {
    for (size_t count = 1; count < 40; ++count) {
      for (size_t place = 0; place < count; ++place) {
        const auto convert = [&](float x, uint16_t half) {
          std::vector<float> in(count, 1.0f);
          std::vector<uint16_t> expected(count, 0x3c00);
          in[place] = x;
          expected[place] = half;
          std::vector<uint16_t> out(count);
          const SampleCounts counts = FloatToHalf(in.data(), count, out.data());
          REQUIRE(out == expected);
          return counts;
        };
        REQUIRE(convert(kMaxHalf, 0x7bff).clamped == 0);
        REQUIRE(convert(beyond, 0x7bff).clamped == 1);
        REQUIRE(convert(-1e30f, 0xfbff).clamped == 1);
        REQUIRE(convert(infinity, 0x7bff).infinite == 1);
        REQUIRE(convert(-infinity, 0xfbff).infinite == 1);
        REQUIRE(convert(-infinity, 0xfbff).clamped == 0);
        REQUIRE(convert(nan, 0x7e00).nan == 1);
        REQUIRE(convert(-nan, 0xfe00).nan == 1);
        REQUIRE(convert(std::bit_cast<float>(0x7f800001u), 0x7e00).nan == 1);
      }
    }
  });
}

TEST_CASE("nothing is written past the last half") {
  ForEachTarget([&](Target) {
    for (size_t count = 0; count < 40; ++count) {
      const std::vector<float> in(count, 2.0f);
      std::vector<uint16_t> out(count + 32, 0xabcd);
      FloatToHalf(in.data(), count, out.data());
      for (size_t i = 0; i < out.size(); ++i) REQUIRE(out[i] == (i < count ? 0x4000 : 0xabcd));
    }
  });
}

TEST_CASE("non-finite floats are counted") {
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  ForEachTarget([&](Target) {
    for (size_t count = 3; count < 40; ++count) {
      std::vector<float> in(count, std::numeric_limits<float>::max());
      CHECK(CountNonfinite(in.data(), count).infinite == 0);
      in[0] = infinity;
      in[count / 2] = -nan;
      in[count - 1] = -infinity;
      const SampleCounts counts = CountNonfinite(in.data(), count);
      CHECK(counts.infinite == 2);
      CHECK(counts.nan == 1);
      CHECK(counts.clamped == 0);
    }
  });
}

}  // namespace
}  // namespace nacre
