// SPDX-License-Identifier: Apache-2.0
// tests/compare/flip_test.cc: FLIP and HDR-FLIP against the formulas of the authors' program
// (tables/flip.json) and where their values can be computed by hand.
#include "compare/flip.h"

#include <cmath>

#include "catch.h"
#include "compare/flip_color.h"
#include "compare/flip_hdr.h"
#include "tables.h"

namespace nacre {
namespace {

// The pictures of the table: 32 levels in every direction, and a quarter of another contrast.
Planes Pattern(int width, int height, int phase, double gain) {
  Planes planes;
  for (int c = 0; c < 3; ++c) {
    Plane& plane = planes[static_cast<size_t>(c)] = Plane(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const int level = x * (7 + 2 * c) + y * (13 - 3 * c) + phase * (x * y % 5);
        double value = level % 32 / 32.0;
        if (x >= width / 2 && y < height / 2) value = value * 0.25 + (c == 1 ? 0.5 : 0.1);
        plane.at(x, y) = value * gain;
      }
    }
  }
  return planes;
}

Planes Even(int size, double r, double g, double b) {
  return {Plane(size, size, r), Plane(size, size, g), Plane(size, size, b)};
}

double MeanOf(const Plane& plane) {
  double sum = 0;
  for (const double value : plane.values) sum += value;
  return sum / static_cast<double>(plane.size());
}

// Double on both sides, sums in another order: 1e-15 each, seen through square roots of differences
// of features of 1e-3 and more, and through powers.
constexpr double kTableTolerance = 1e-9;

void CheckMap(const Plane& map, const nlohmann::json& row) {
  CHECK(MeanOf(map) == Approx(TableNumber(row["mean"])).margin(kTableTolerance));
  for (const auto& pixel : row["pixels"]) {
    CHECK(map.at(pixel[0], pixel[1]) == Approx(TableNumber(pixel[2])).margin(kTableTolerance));
  }
}

TEST_CASE("FLIP is that of the authors' formulas", "[flip][table]") {
  const nlohmann::json table = LoadTable("flip");
  for (const auto& row : table["ldr"]) {
    const int width = row["width"], height = row["height"];
    CAPTURE(width, height, row["ppd"]);
    CheckMap(FlipMap(Pattern(width, height, 0, 1), Pattern(width, height, 3, 1),
                     TableNumber(row["ppd"])),
             row);
  }
}

TEST_CASE("HDR-FLIP is that of the authors' formulas", "[flip][table]") {
  const nlohmann::json table = LoadTable("flip");
  for (const auto& row : table["hdr"]) {
    Planes pictures[2];
    for (int i = 0; i < 2; ++i) {
      pictures[i] = Pattern(row["width"], row["height"], i + 1, row["gain"]);
      for (Plane& plane : pictures[i]) plane.at(3, 2) *= 40;
    }
    const ExposureRange range = FlipExposures(pictures[0]);
    CHECK(range.start == Approx(TableNumber(row["start"])).epsilon(1e-12));
    CHECK(range.stop == Approx(TableNumber(row["stop"])).epsilon(1e-12));
    CHECK(range.count == row["count"]);
    CheckMap(HdrFlipMap(pictures[0], pictures[1], range, kDefaultPixelsPerDegree).error, row);
  }
}

TEST_CASE("Equal pictures have no FLIP", "[flip]") {
  const Planes picture = Pattern(19, 13, 1, 1);
  for (const double value : FlipMap(picture, picture, 67).values) CHECK(value == 0);
}

TEST_CASE("The FLIP of even colours is that of their distance", "[flip]") {
  // No features, and filters keep what is even. Black and white are 100 apart in L*, HyAB^0.7 is
  // 25.1189. Green is L* 87.735, a* -86.183, b* 83.179 (by Hunt -75.613 and 72.977), blue 32.297,
  // 79.188, -107.860 (25.575 and -34.836): 55.438 + 147.862 apart, ^0.7 is 41.2758. From 0.4 of
  // that, 16.5103, on, the last 0.05 of the scale: 0.95 + 0.05 (25.1189 - 16.5103) / 24.7655.
  // Five digits of the colours leave 1e-5 of the distances.
  const Plane white = FlipMap(Even(9, 0, 0, 0), Even(9, 1, 1, 1), 67);
  CHECK(white.at(4, 4) == Approx(0.967380).margin(1e-6));
  CHECK(FlipMap(Even(9, 0, 1, 0), Even(9, 0, 0, 1), 67).at(0, 0) == Approx(1).epsilon(1e-12));
  // Greys, below 16.5103: 0.95 / 16.5103 times (116 (cbrt 0.5 - cbrt 0.2))^0.7.
  const double between = 116 * (std::cbrt(0.5) - std::cbrt(0.2));
  CHECK(FlipMap(Even(3, 0.2, 0.2, 0.2), Even(3, 0.5, 0.5, 0.5), 67).at(1, 1) ==
        Approx(0.95 / 16.5103 * std::pow(between, 0.7)).epsilon(1e-5));
}

TEST_CASE("FLIP does not mind which picture is which", "[flip]") {
  const Planes a = Pattern(20, 12, 0, 1), b = Pattern(20, 12, 4, 1);
  const Plane forth = FlipMap(a, b, 40), back = FlipMap(b, a, 40);
  for (size_t i = 0; i < forth.size(); ++i) CHECK(forth.values[i] == back.values[i]);
}

TEST_CASE("FLIP grows with the difference of greys", "[flip]") {
  double last = 0;
  for (const double grey : {0.21, 0.25, 0.4, 0.7, 1.0}) {
    const double now = FlipMap(Even(5, 0.2, 0.2, 0.2), Even(5, grey, grey, grey), 67).at(2, 2);
    CHECK(now > last);
    last = now;
  }
}

TEST_CASE("A dot is seen where it is, and an edge more than the colours beside it", "[flip]") {
  Planes dot = Even(41, 0.2, 0.2, 0.2);
  for (Plane& plane : dot) plane.at(20, 20) = 1;
  const Plane map = FlipMap(Even(41, 0.2, 0.2, 0.2), dot, 67);
  CHECK(map.at(20, 20) > 0.1);
  CHECK(map.at(0, 0) < 1e-9);  // 20 pixels off: beyond both filters, of radius 10 and 9
  CHECK(map.at(19, 20) == Approx(map.at(21, 20)).epsilon(1e-9));
  CHECK(map.at(20, 19) == Approx(map.at(19, 20)).epsilon(1e-9));
  // An edge: half the picture brighter. At the edge FLIP exceeds that of the even colours.
  Planes edge = Even(41, 0.2, 0.2, 0.2);
  for (Plane& plane : edge) {
    for (int y = 0; y < 41; ++y) {
      for (int x = 21; x < 41; ++x) plane.at(x, y) = 0.4;
    }
  }
  const Plane step = FlipMap(Even(41, 0.2, 0.2, 0.2), edge, 67);
  CHECK(step.at(22, 20) > step.at(40, 20));
}

TEST_CASE("More pixels per degree hide a fine pattern", "[flip]") {
  Planes checks = Even(24, 0, 0, 0), greys = Even(24, 0.5, 0.5, 0.5);
  for (Plane& plane : checks) {
    for (int y = 0; y < 24; ++y) {
      for (int x = 0; x < 24; ++x) plane.at(x, y) = (x + y) % 2;
    }
  }
  const double near = MeanOf(FlipMap(greys, checks, 20));
  const double far = MeanOf(FlipMap(greys, checks, 120));
  CHECK(far < 0.2 * near);
}

TEST_CASE("Exposures come from the reference, and black does not make them infinite", "[flip]") {
  // ACES(0.6 x) = 0.85: the root, put into the curve.
  Planes planes = Even(4, 1, 1, 1);
  const ExposureRange even = FlipExposures(planes);
  const double shown = 0.6 * std::exp2(even.start);
  CHECK(shown * (2.51 * shown + 0.03) / (shown * (2.43 * shown + 0.59) + 0.14) ==
        Approx(0.85).epsilon(1e-12));
  CHECK((even.stop == even.start && even.count == 2));
  for (Plane& plane : planes) plane.values.assign(16, 0.0);
  CHECK(FlipExposures(planes).count == 1);
  // One of four rows is lit: 1, 2, 4, 8.
  for (Plane& plane : planes) {
    for (int x = 0; x < 4; ++x) plane.at(x, 0) = std::ldexp(1, x);
  }
  const ExposureRange lit = FlipExposures(planes);
  CHECK(lit.start == Approx(even.start - 3).epsilon(1e-12));              // 8
  CHECK(lit.stop == Approx(even.start - std::log2(3.0)).epsilon(1e-12));  // (2 + 4) / 2
  CHECK(lit.count == 2);
}

TEST_CASE("HDR-FLIP keeps the exposure that shows the most", "[flip]") {
  // Alike where dark, 100 and 200 where bright: white both at exposure 0, apart in the dark.
  Planes a = Even(3, 100, 100, 100), b = Even(3, 200, 200, 200);
  const HdrFlip flip = HdrFlipMap(a, b, {-8, 0, 9}, 67);
  CHECK(flip.exposure.at(1, 1) < -4);
  CHECK(flip.error.at(1, 1) > 0.2);
  CHECK(HdrFlipMap(a, b, {0, 0, 1}, 67).error.at(1, 1) == 0);
}

TEST_CASE("The matrix and its inverse belong together", "[flip]") {
  for (const flip::Triple& rgb : {flip::Triple{1, 0, 0}, {0, 1, 0}, {0.2, 0.3, 0.9}}) {
    const flip::Triple back = flip::RgbFromYcc(flip::YccFromRgb(rgb));
    for (size_t c = 0; c < 3; ++c) CHECK(back[c] == Approx(rgb[c]).margin(1e-13));
  }
  CHECK(kDefaultPixelsPerDegree == Approx(3840 * M_PI / 180).epsilon(1e-15));
}

}  // namespace
}  // namespace nacre
