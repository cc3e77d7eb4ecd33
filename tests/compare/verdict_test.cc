// SPDX-License-Identifier: Apache-2.0
// tests/compare/verdict_test.cc: match or differ, and the reason in words.
#include "compare/verdict.h"

#include <limits>

#include "base/error.h"
#include "catch.h"
#include "compare/test_images.h"

namespace nacre {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Pair {
  Image got = MakeImage({0, 0, 100, 100}, {"R", "G", "B"}, 2);
  Image reference = got;
};

TEST_CASE("By default images must be equal", "[compare]") {
  Pair pair;
  Verdict verdict = Judge(pair.got, pair.reference, {});
  CHECK(verdict.match);
  CHECK(verdict.reason == "none of 10000 pixels differs");
  SampleAt(pair.got, "B", 12, 34) = 2.5f;
  verdict = Judge(pair.got, pair.reference, {});
  CHECK_FALSE(verdict.match);
  CHECK(verdict.exceeding_pixels == 1);
  CHECK(verdict.reason ==
        "1 of 10000 pixels (0.01 %) differ, 0 % may; worst B at (12, 34): 2.5 instead of 2");
}

TEST_CASE("Absolute and relative tolerances add up", "[compare]") {
  Pair pair;
  SampleAt(pair.got, "R", 0, 0) = 2.375f;
  Tolerances tolerances{.max_abs = 0.125};
  tolerances.max_rel = 0.125;  // 0.375 in all, met exactly
  CHECK(Judge(pair.got, pair.reference, tolerances).match);
  SampleAt(pair.got, "R", 0, 0) = 2.376f;
  CHECK_FALSE(Judge(pair.got, pair.reference, tolerances).match);
  SampleAt(pair.got, "R", 0, 0) = 1.624f;
  const Verdict verdict = Judge(pair.got, pair.reference, tolerances);
  CHECK_FALSE(verdict.match);
  CHECK(verdict.reason.find("differ by more than 0.125 + 0.125 |reference|") != std::string::npos);
}

TEST_CASE("A fraction of the pixels may exceed", "[compare]") {
  Pair pair;
  Tolerances tolerances{.exceeding_fraction = 2e-4};
  SampleAt(pair.got, "R", 0, 0) = 9;
  SampleAt(pair.got, "G", 0, 0) = 9;  // the same pixel
  SampleAt(pair.got, "G", 1, 0) = 9;
  Verdict verdict = Judge(pair.got, pair.reference, tolerances);
  CHECK(verdict.match);
  CHECK(verdict.exceeding_pixels == 2);
  CHECK(verdict.reason == "2 of 10000 pixels (0.02 %) differ, 0.02 % may");
  SampleAt(pair.got, "B", 2, 0) = 9;
  CHECK_FALSE(Judge(pair.got, pair.reference, tolerances).match);
}

TEST_CASE("RMSE is judged by layer", "[compare]") {
  Image got = MakeImage({0, 0, 10, 10}, {"R", "N.X"}, 1);
  const Image reference = got;
  SampleAt(got, "N.X", 5, 5) = 2;
  Tolerances tolerances;
  tolerances.exceeding_fraction = 1;
  tolerances.rmse = 0.1000001;
  CHECK(Judge(got, reference, tolerances).match);
  tolerances.rmse = 0.05;
  const Verdict verdict = Judge(got, reference, tolerances);
  CHECK_FALSE(verdict.match);
  CHECK(verdict.reason == "RMSE of N is 0.1, 0.05 is allowed");
}

TEST_CASE("A limit of the RMSE alone is the whole verdict", "[compare]") {
  Image got = MakeImage({0, 0, 10, 10}, {"R", "N.X"}, 1);
  const Image reference = got;
  SampleAt(got, "N.X", 5, 5) = 2;
  Tolerances tolerances;
  tolerances.rmse = 0.1000001;
  CHECK(Judge(got, reference, tolerances).match);
  CHECK(Judge(got, reference, tolerances).reason == "no layer's RMSE is more than 0.1");
  tolerances.rmse = 0.09;
  CHECK(Judge(got, reference, tolerances).reason == "RMSE of N is 0.1, 0.09 is allowed");
  SampleAt(got, "N.X", 5, 5) = kNan;
  tolerances.rmse = 1e30;
  CHECK_FALSE(Judge(got, reference, tolerances).match);
}

TEST_CASE("No tolerance forgives a NaN", "[compare]") {
  Pair pair;
  SampleAt(pair.got, "R", 7, 8) = kNan;
  Tolerances tolerances{.max_abs = 1e30};
  const Verdict verdict = Judge(pair.got, pair.reference, tolerances);
  CHECK_FALSE(verdict.match);
  CHECK(verdict.reason.find("worst R at (7, 8): nan instead of 2") != std::string::npos);
  SampleAt(pair.reference, "R", 7, 8) = kNan;
  CHECK(Judge(pair.got, pair.reference, tolerances).match);
}

TEST_CASE("Windows that differ are a difference, unless crops are allowed", "[compare]") {
  const Image whole = MakeImage({0, 0, 100, 100}, {"R", "G", "B"}, 2);
  Image crop = MakeImage({10, 20, 40, 60}, {"R", "G", "B"}, 2);
  crop.display = whole.display;
  CompareOptions options;
  Verdict verdict = Judge(crop, whole, {}, options);
  CHECK_FALSE(verdict.match);
  CHECK(verdict.reason ==
        "the data window is 30x40 at 10,20, not 100x100 at 0,0; the pixels that both have match");
  options.crop = true;
  verdict = Judge(crop, whole, {}, options);
  CHECK(verdict.match);
  CHECK(verdict.pixels == 1200);
  Image moved = whole;
  moved.display = {1, 0, 101, 100};
  CHECK(Judge(moved, whole, {}).reason.starts_with("the display window is 100x100 at 1,0, not"));
  const Image part = MakeImage({0, 0, 50, 40}, {"R", "G", "B"}, 2);
  CHECK_THROWS_AS(Judge(part, whole, {}), Error);
  CompareOptions any_size{.sizes_may_differ = options.sizes_may_differ = true};
  CHECK(Judge(part, whole, {}, any_size).reason ==
        "the display window is 50x40 at 0,0, not 100x100 at 0,0; the pixels that both have match");
  CHECK(Judge(part, whole, {}, options).match);
  SampleAt(crop, "G", 12, 30) = 3;
  CHECK(
      Judge(crop, whole, {}).reason ==
      "the data window is 30x40 at 10,20, not 100x100 at 0,0; 1 of 1200 pixels (0.0833 %) differ, "
      "0 % may; worst G at (12, 30): 3 instead of 2");
}

// A small error in the dark is not worse than a large one: there is one worst sample of a layer.
TEST_CASE("The worst sample is that of the layer's largest error", "[compare]") {
  Image reference = MakeImage({0, 0, 100, 100}, {"R", "G", "B"}, 0);
  Image got = reference;
  SampleAt(got, "R", 3, 4) = 0.5f;
  for (const char* channel : {"R", "G", "B"}) {
    SampleAt(reference, channel, 70, 80) = 100;
    SampleAt(got, channel, 70, 80) = 102;
    SampleAt(reference, channel, 9, 90) = 7;
    SampleAt(got, channel, 9, 90) = 5;  // as large, and later
  }
  const Verdict verdict = Judge(got, reference, {});
  REQUIRE(verdict.layers.size() == 1);
  const DifferenceSite& at = verdict.layers[0].max_abs_at;
  CHECK((at.x == 70 && at.y == 80));
  CHECK(verdict.reason.ends_with("worst " + at.channel + " at (70, 80): 102 instead of 100"));
}

}  // namespace
}  // namespace nacre
