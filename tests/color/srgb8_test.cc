// SPDX-License-Identifier: Apache-2.0
// tests/color/srgb8_test.cc: 8-bit sRGB codes are exact for every float, on every target.
#include "color/srgb8.h"

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "catch.h"
#include "color/display.h"
#include "color/transfer.h"
#include "tables.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

// The definition, in double.
int ExactCode(float linear) {
  const double x = std::min(std::max(static_cast<double>(linear), 0.0), 1.0);
  return static_cast<int>(std::floor(255 * SrgbOetf(x) + 0.5));
}

// The codes that EncodeDisplay gives to greys.
std::vector<uint8_t> EncodeGreys(const std::vector<float>& greys) {
  DisplaySettings settings{.tone = ToneOperator::kNone};
  std::vector<uint8_t> rgb8(3 * greys.size());
  EncodeDisplay(settings, greys.data(), greys.data(), greys.data(), greys.size(), rgb8.data());
  std::vector<uint8_t> codes;
  for (size_t i = 0; i < greys.size(); ++i) {
    if (rgb8[3 * i] != rgb8[3 * i + 1] || rgb8[3 * i] != rgb8[3 * i + 2]) FAIL("not grey");
    codes.push_back(rgb8[3 * i]);
  }
  return codes;
}

// Floats that would show an error in the table: both ends of every bucket, floats of random
// octaves, and special values.
std::vector<float> TestFloats() {
  std::vector<float> floats = {0.0f, -0.0f, -1.0f, 1.0f, 2.0f, 1e30f, kInf, -kInf, 1e-45f, 1e-20f};
  for (uint32_t bits = Srgb8Table::kFirstBits; bits < 0x3f810000u; bits += 0x10000u) {
    for (const uint32_t near : {bits - 1, bits, bits + 1})
      floats.push_back(std::bit_cast<float>(near));
  }
  std::mt19937 engine(1);
  std::uniform_int_distribution<uint32_t> random_bits(0x38000000u, 0x3f900000u);
  for (int i = 0; i < 200'000; ++i) floats.push_back(std::bit_cast<float>(random_bits(engine)));
  return floats;
}

TEST_CASE("All 255 transitions of the 8-bit code are exact on every target", "[color][table]") {
  std::vector<float> floats;
  std::vector<int> expected;
  const auto rows = LoadTable("srgb8_thresholds").at("rows");
  for (const auto& row : rows) {
    const float threshold = std::bit_cast<float>(
        static_cast<uint32_t>(std::stoul(row.at("bits").get<std::string>(), nullptr, 16)));
    const int code = row.at("code").get<int>();
    floats.insert(floats.end(), {std::nextafter(threshold, 0.0f), threshold});
    expected.insert(expected.end(), {code - 1, code});
  }
  for (size_t i = 0; i < floats.size(); ++i) {
    CAPTURE(floats[i]);
    CHECK(Srgb8(floats[i]) == expected[i]);
  }
  ForEachTarget([&](Target) {
    const std::vector<uint8_t> codes = EncodeGreys(floats);
    for (size_t i = 0; i < floats.size(); ++i) {
      if (codes[i] != expected[i]) FAIL_CHECK("code " << int(codes[i]) << " of " << floats[i]);
    }
  });
}

TEST_CASE("8-bit codes are those of the double definition on every target", "[color]") {
  const std::vector<float> floats = TestFloats();
  for (const float x : floats) {
    if (Srgb8(x) != ExactCode(x)) FAIL_CHECK("code " << int(Srgb8(x)) << " of " << x);
  }
  ForEachTarget([&](Target) {
    const std::vector<uint8_t> codes = EncodeGreys(floats);
    for (size_t i = 0; i < floats.size(); ++i) {
      if (codes[i] != ExactCode(floats[i])) {
        FAIL_CHECK("code " << int(codes[i]) << " of " << floats[i]);
      }
    }
  });
}

TEST_CASE("No bucket of the sRGB table holds two thresholds", "[color]") {
  // Then a code could never be skipped, and each step from one bucket to the next is 0 or 1.
  int previous = 0;
  for (size_t i = 0; i < Srgb8Table::kBuckets; ++i) {
    const auto bits = static_cast<uint32_t>(Srgb8Table::kFirstBits + (i << 16) + 0xffffu);
    const int code = Srgb8(std::bit_cast<float>(bits));
    CHECK((code == previous || code == previous + 1));
    previous = code;
  }
  CHECK(previous == 255);
}

}  // namespace
}  // namespace nacre
