// SPDX-License-Identifier: Apache-2.0
// tests/render/interval_test.cc: what a pixel's replicates tell of its error.
#include "render/interval.h"

#include <cmath>

#include "catch.h"

namespace nacre {
namespace {

constexpr PixelRange kNone{1, -1};

double HalfWidth(const Interval& measured) { return std::sqrt(measured.half_width2); }

// Student's t of three degrees of freedom, 3.182446305, times the standard error of the mean, here
// sqrt(5/3) / 2.
TEST_CASE("an interval is Student's") {
  const Interval measured = MeasureSpread({1, 2, 3, 4});
  CHECK(measured.mean == 2.5);
  CHECK(std::abs(HalfWidth(measured) - 3.182446305 * std::sqrt(5.0 / 3) / 2) < 1e-8);
  CHECK(MeasureSpread({3, 3, 3, 3}).half_width2 == 0);
}

TEST_CASE("samples of an outline that agree may all be wrong by one") {
  const double background = 0.25;
  // 16 samples, all of the background: the next one may hit, and be 10.
  CHECK(HalfWidth(MeasureOnOutline({0.25, 0.25, 0.25, 0.25}, {2, 10}, &background, 16)) ==
        9.75 / 16);
  // All hit: the next one may miss, if there is anything behind.
  CHECK(HalfWidth(MeasureOnOutline({0.75, 0.75, 0.75, 0.75}, kNone, nullptr, 16)) == 0.75 / 16);
  const double bright = 5;
  CHECK(HalfWidth(MeasureOnOutline({0.75, 0.75, 0.75, 0.75}, kNone, &bright, 16)) == 4.25 / 16);
  // Where all is black: as much as is told from black.
  CHECK(HalfWidth(MeasureOnOutline({0, 0, 0, 0}, kNone, nullptr, 16)) == kDarkest / 16);
}

TEST_CASE("hits are weighed by the share that is covered") {
  // Of 16 samples 1, 3, 2 and 2 of four hit, all with 5, before 1.
  const double hits[kReplicates] = {0.25, 0.75, 0.5, 0.5};
  const double values[kReplicates] = {2, 4, 3, 3};
  const Interval measured = MeasureCovered(values, hits, 0.375, {5, 5}, 1, 16);
  CHECK(std::abs(measured.mean - (1 + 0.375 * 4)) < 1e-15);
  CHECK(measured.half_width2 < 1e-30);
  // Other hits around it are between 4 and 6: eight of them that agree may be wrong by an eighth.
  CHECK(std::abs(HalfWidth(MeasureCovered(values, hits, 0.375, {4, 6}, 1, 16)) - 0.375 * 2 / 8) <
        1e-15);
}

TEST_CASE("one hit is not all hits, and none is not nothing") {
  const double one[kReplicates] = {0.25, 0, 0, 0};
  const double background = 1;
  // 5 in one of 16 samples, of which a tenth would hit.
  const Interval single = MeasureCovered({2, 1, 1, 1}, one, 0.1, {5, 5}, background, 16);
  CHECK(std::abs(single.mean - 1.4) < 1e-15);
  CHECK(std::abs(HalfWidth(single) - 0.1 * 4) < 1e-15);
  const double none[kReplicates] = {};
  const Interval missed = MeasureCovered({1, 1, 1, 1}, none, 0.1, {3, 5}, background, 16);
  CHECK(missed.mean == 1);
  CHECK(std::abs(HalfWidth(missed) - 0.1 * 4) < 1e-15);
}

}  // namespace
}  // namespace nacre
