// SPDX-License-Identifier: Apache-2.0
// tests/color/primaries_test.cc: matrices of primaries against published ones.
#include "color/primaries.h"

#include <algorithm>

#include "catch.h"

namespace nacre {
namespace {

double LargestDifference(const Imath::M33d& a, const Imath::M33d& b) {
  double largest = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) largest = std::max(largest, std::abs(a[i][j] - b[i][j]));
  }
  return largest;
}

// Published for column vectors.
Imath::M33d Transposed(double a, double b, double c, double d, double e, double f, double g,
                       double h, double i) {
  return {a, d, g, b, e, h, c, f, i};
}

Imath::M33d ToRec709(const char* primaries) {
  return Rec709FromPrimaries(*ParsePrimaries(primaries));
}

TEST_CASE("Rec. 709 and its XYZ") {
  CHECK(LargestDifference(ToRec709("0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329"), {}) < 1e-14);
  // IEC 61966-2-1, four digits.
  CHECK(LargestDifference(
            XyzFromRgb(*ParsePrimaries(kRec709Primaries)),
            Transposed(.4124, .3576, .1805, .2126, .7152, .0722, .0193, .1192, .9505)) < 1e-4);
}

TEST_CASE("matrices that others publish") {
  // ITU-R BT.2087-0 has the inverse of its four digits; these are of ITU-R BT.2407-0, section 2.
  CHECK(LargestDifference(ToRec709("0.708 0.292 0.17 0.797 0.131 0.046 0.3127 0.329"),
                          Transposed(1.6605, -.5876, -.0728, -.1246, 1.1329, -.0083, -.0182, -.1006,
                                     1.1187)) < 1e-4);
  // ACES2065-1 to linear sRGB by Bradford, OpenColorIO's built-in transform, six digits.
  CHECK(LargestDifference(ToRec709("0.7347 0.2653 0 1 0.0001 -0.077 0.32168 0.33767"),
                          Transposed(2.521686, -1.134131, -.387555, -.276480, 1.372719, -.096239,
                                     -.015378, -.152975, 1.168353)) < 2e-5);
}

TEST_CASE("grey stays grey, but where the primaries are X, Y and Z") {
  for (const char* primaries : {"0.7347 0.2653 0 1 0.0001 -0.077 0.32168 0.33767",
                                "0.68 0.32 0.265 0.69 0.15 0.06 0.314 0.351",
                                "0.7347 0.2653 0.1596 0.8404 0.0366 0.0001 0.3457 0.3585"}) {
    const Vec3d grey = Vec3d(1, 1, 1) * ToRec709(primaries);
    CAPTURE(primaries);
    for (int c = 0; c < 3; ++c) CHECK(std::abs(grey[c] - 1) < 1e-12);
  }
  const Imath::M33d rgb_from_xyz = XyzFromRgb(*ParsePrimaries(kRec709Primaries)).inverse();
  // The white of files is 1/3 as a float has it, 1e-8 off, times the matrix.
  CHECK(LargestDifference(ToRec709("1 0 0 1 0 0 0.33333334 0.33333334"), rgb_from_xyz) < 1e-7);
}

TEST_CASE("what names no primaries") {
  for (const char* text :
       {"", "0 0 0 0 0 0 0 0", "0.64 0.33 0.3 0.6 0.15 0.06 0.3127", "a b c d e f g h",
        "0.64 0.33 0.3 0.6 0.15 0.06 0 0", "0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0",
        "0.64 0.33 0.64 0.33 0.64 0.33 0.3127 0.329",  // one point
        "0.1 0.1 0.2 0.2 0.3 0.3 0.2 0.2",             // a line
        "0.64 0.33 0.3 0.6 0.15 0.06 0.9 0.05",        // a white that they cannot mix
        "0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329abc", "0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329 1",
        "0.64.33.3.6.15.06.3127.329",  // no blanks
        "nan 0.33 0.3 0.6 0.15 0.06 0.3127 0.329", "1e300 0.33 0.3 0.6 0.15 0.06 0.3127 0.329"}) {
    CAPTURE(text);
    CHECK_FALSE(ParsePrimaries(text).has_value());
  }
}

TEST_CASE("primaries are the same as far as files agree") {
  const auto same = [](const char* a, const char* b) {
    return SamePrimaries(*ParsePrimaries(a), *ParsePrimaries(b));
  };
  const char* const rec709 = "0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329";
  CHECK(same(rec709, "0.640 0.330 0.300 0.600 0.150 0.060 0.31271 0.32902"));
  CHECK(same(rec709, "0.64 0.33 0.3 0.6 0.15 0.06 0.3128 0.3292"));
  CHECK(same(rec709, " +0.64\t0.33 .3 .6 .15 .06 0.3127 0.329 "));
  CHECK_FALSE(same(rec709, "0.68 0.32 0.265 0.69 0.15 0.06 0.3127 0.329"));
}

}  // namespace
}  // namespace nacre
