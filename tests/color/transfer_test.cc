// SPDX-License-Identifier: Apache-2.0
// tests/color/transfer_test.cc: the sRGB curves in double, and luminance.
#include "color/transfer.h"

#include <cmath>

#include "catch.h"
#include "color/luminance.h"
#include "color/srgb8.h"
#include "tables.h"

namespace nacre {
namespace {

// The tables' rule: 16 half-ulps, here of double, for the curves that contain a power.
constexpr double kCurveTolerance = 16 * kHalfUlpDouble;

TEST_CASE("sRGB encoding agrees with the table", "[color][table]") {
  const auto rows = LoadTable("tonemap").at("scalar");
  for (const auto& row : rows) {
    const double x = std::min(TableNumber(row.at("x")), 1.0);
    const double expected = TableNumber(row.at("srgb_oetf_clamped"));
    CAPTURE(x);
    CHECK(std::abs(SrgbOetf(x) - expected) <= kCurveTolerance * expected);
    CHECK(std::floor(255 * SrgbOetf(x) + 0.5) == row.at("srgb8_of_oetf").get<int>());
    CHECK(Srgb8(static_cast<float>(x)) == row.at("srgb8_of_oetf").get<int>());
  }
}

TEST_CASE("8-bit codes decode to the table and encode back", "[color][table]") {
  const auto decoded = LoadTable("tonemap_facts").at("srgb_eotf_8bit");
  REQUIRE(decoded.size() == 256);
  for (int code = 0; code < 256; ++code) {
    const double linear = SrgbEotf(code / 255.0);
    const double expected = TableNumber(decoded[static_cast<size_t>(code)]);
    CAPTURE(code);
    CHECK(std::abs(linear - expected) <= kCurveTolerance * expected);
    CHECK(std::abs(static_cast<float>(linear) - expected) <= 2 * kHalfUlpFloat * expected);
    CHECK(Srgb8(static_cast<float>(linear)) == code);
  }
}

TEST_CASE("sRGB is not a power of 2.2", "[color][table]") {
  const auto facts = LoadTable("tonemap_facts");
  double largest = 0;
  for (int i = 1; i <= 1'000'000; ++i) {
    const double x = i * 1e-6;
    largest = std::max(largest, std::abs(std::pow(x, 1 / 2.2) - SrgbOetf(x)));
  }
  // The scan's step of 1e-6 misses the maximum, which is flat there, by far less than 1e-6.
  CHECK(std::abs(largest - TableNumber(facts.at("max_abs_gamma22_vs_srgb_dark").at(0))) < 1e-6);
}

TEST_CASE("sRGB decoding inverts encoding", "[color]") {
  for (int i = 0; i <= 100'000; ++i) {
    const double x = i * 1e-5;
    // Between the two break points of the standard the pieces differ by 2.9e-8 encoded, 2.3e-9
    // linear.
    CHECK(std::abs(SrgbEotf(SrgbOetf(x)) - x) <= 3e-9);
  }
  const double below = SrgbOetf(0.0031308);
  const double above = SrgbOetf(std::nextafter(0.0031308, 1.0));
  CHECK(std::abs(above - below) < 2.9e-8);
}

TEST_CASE("Luminance of white is 1", "[color]") {
  CHECK(Luminance(Imath::Color3<double>(1, 1, 1)) == Approx(1).epsilon(1e-15));
  CHECK(Luminance(Imath::Color3<double>(0, 1, 0)) == 0.7152);
}

}  // namespace
}  // namespace nacre
