// SPDX-License-Identifier: Apache-2.0
// tests/compare/flip_test.cc: FLIP and HDR-FLIP against the formulas of the authors' program
// (tables/flip.json), against their twin in double, and where their values can be computed by hand.
#include "compare/flip.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "catch.h"
#include "compare/flip_color.h"
#include "compare/flip_twin.h"
#include "tables.h"
#include "targets.h"

namespace nacre {
namespace {

using flip_twin::ExactPlane;
using flip_twin::ExactPlanes;

// The pictures of the table: 32 levels in every direction, and a quarter of another contrast.
ExactPlanes Pattern(int width, int height, int phase, double gain) {
  ExactPlanes planes;
  for (int c = 0; c < 3; ++c) {
    ExactPlane& plane = planes[static_cast<size_t>(c)] = ExactPlane(width, height);
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

ExactPlanes Even(int size, double r, double g, double b) {
  return {ExactPlane(size, size, r), ExactPlane(size, size, g), ExactPlane(size, size, b)};
}

// The same in float, with more samples from a row to the next than pixels.
struct FloatPicture {
  explicit FloatPicture(const ExactPlanes& planes) {
    view.width = planes[0].width;
    view.height = planes[0].height;
    view.stride = static_cast<size_t>(view.width) + 3;
    for (size_t c = 0; c < 3; ++c) {
      samples[c].resize(view.stride * static_cast<size_t>(view.height));
      for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
          samples[c][static_cast<size_t>(y) * view.stride + static_cast<size_t>(x)] =
              static_cast<float>(planes[c].at(x, y));
        }
      }
      view.rgb[c] = samples[c].data();
    }
  }
  FloatPicture(const FloatPicture&) = delete;
  FloatPicture& operator=(const FloatPicture&) = delete;

  std::vector<float> samples[3];
  PictureView view;
};

ExactPlanes Rounded(ExactPlanes planes) {
  for (ExactPlane& plane : planes) {
    for (double& value : plane.values) value = static_cast<float>(value);
  }
  return planes;
}

// Of light.
Plane FlipOf(const ExactPlanes& reference, const ExactPlanes& test, double pixels_per_degree) {
  const FloatPicture a(reference), b(test);
  const ShowPair show = {{}, {}, /*alike=*/true};
  return nacre::FlipMap(a.view, b.view, std::span(&show, 1), pixels_per_degree);
}

Plane HdrFlipOf(const ExactPlanes& reference, const ExactPlanes& test, const ExposureRange& range) {
  const FloatPicture a(reference), b(test);
  return nacre::HdrFlipMap(a.view, b.view, range, kDefaultPixelsPerDegree);
}

double MeanOf(const ExactPlane& plane) {
  double sum = 0;
  for (const double value : plane.values) sum += value;
  return sum / static_cast<double>(plane.size());
}
double MeanOf(const Plane& plane) { return Mean(plane); }

// Double on both sides, sums in another order: 1e-15 each, seen through square roots of differences
// of features of 1e-3 and more, and through powers.
constexpr double kTableTolerance = 1e-9;
// Of the kernels: float's rounding, as compare/flip.h says.
constexpr double kPixelTolerance = 1e-3, kMeanTolerance = 1e-6;
constexpr double kUsualTolerance = 1e-4, kUnusualPixels = 1e-3;  // of all

template <class Map>
void CheckMap(const Map& map, const nlohmann::json& row, double of_mean, double of_pixels) {
  CHECK(MeanOf(map) == Approx(TableNumber(row["mean"])).margin(of_mean));
  for (const auto& pixel : row["pixels"]) {
    CHECK(map.at(pixel[0], pixel[1]) == Approx(TableNumber(pixel[2])).margin(of_pixels));
  }
}

void CheckTwins(const Plane& kernel, const ExactPlane& twin) {
  size_t worst = 0, unusual = 0;
  const auto error = [&](size_t i) { return std::abs(kernel.values[i] - twin.values[i]); };
  for (size_t i = 0; i < twin.size(); ++i) {
    if (error(i) > error(worst)) worst = i;
    unusual += error(i) > kUsualTolerance;
  }
  CAPTURE(worst, kernel.values[worst], twin.values[worst]);
  CHECK(error(worst) <= kPixelTolerance);
  CHECK(static_cast<double>(unusual) <= kUnusualPixels * static_cast<double>(twin.size()));
  CHECK(MeanOf(kernel) == Approx(MeanOf(twin)).margin(kMeanTolerance));
}

TEST_CASE("FLIP is that of the authors' formulas", "[flip][table]") {
  const nlohmann::json table = LoadTable("flip");
  for (const auto& row : table["ldr"]) {
    const int width = row["width"], height = row["height"];
    CAPTURE(width, height, row["ppd"]);
    const ExactPlanes a = Pattern(width, height, 0, 1), b = Pattern(width, height, 3, 1);
    const double ppd = TableNumber(row["ppd"]);
    CheckMap(flip_twin::FlipMap(a, b, ppd), row, kTableTolerance, kTableTolerance);
    CheckMap(FlipOf(a, b, ppd), row, kMeanTolerance, kPixelTolerance);
  }
}

TEST_CASE("HDR-FLIP is that of the authors' formulas", "[flip][table]") {
  const nlohmann::json table = LoadTable("flip");
  for (const auto& row : table["hdr"]) {
    ExactPlanes pictures[2];
    for (int i = 0; i < 2; ++i) {
      pictures[i] = Pattern(row["width"], row["height"], i + 1, row["gain"]);
      for (ExactPlane& plane : pictures[i]) plane.at(3, 2) *= 40;
    }
    // The brightest sample is a float as it is; the median is rounded to one, by up to 1e-7 stops.
    const ExposureRange range = FlipExposures(FloatPicture(pictures[0]).view);
    CHECK(range.start == Approx(TableNumber(row["start"])).epsilon(1e-12));
    CHECK(range.stop == Approx(TableNumber(row["stop"])).margin(2e-7));
    CHECK(range.count == row["count"]);
    const ExposureRange exact = {TableNumber(row["start"]), TableNumber(row["stop"]), row["count"]};
    CheckMap(flip_twin::HdrFlipMap(pictures[0], pictures[1], exact, kDefaultPixelsPerDegree), row,
             kTableTolerance, kTableTolerance);
    CheckMap(HdrFlipOf(pictures[0], pictures[1], range), row, kMeanTolerance, kPixelTolerance);
  }
}

TEST_CASE("FLIP of floats is that of doubles on every target", "[flip]") {
  // Wider and higher than a tile and its filters; alike, nearly alike and different; other pixels
  // per degree move every radius.
  const int width = 300, height = 290;
  const ExactPlanes a = Rounded(Pattern(width, height, 0, 1));
  ExactPlanes near = a, half = a;
  for (size_t c = 0; c < 3; ++c) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        near[c].at(x, y) *= 1 + 1e-4 * std::sin(0.3 * x + 0.2 * y);
        if (x > 200 && y > 40 && y < 60) half[c].at(x, y) = 1 - half[c].at(x, y);
      }
    }
  }
  const ExactPlanes tests[] = {Rounded(Pattern(width, height, 4, 1)), Rounded(near), half};
  for (const ExactPlanes& test : tests) {
    CAPTURE(&test - tests);
    for (const double ppd : {12.5, kDefaultPixelsPerDegree}) {
      CAPTURE(ppd);
      const ExactPlane twin = flip_twin::FlipMap(a, test, ppd);
      ForEachTarget([&](Target) { CheckTwins(FlipOf(a, test, ppd), twin); });
    }
  }
}

TEST_CASE("HDR-FLIP of floats is that of doubles on every target", "[flip]") {
  const ExactPlanes a = Rounded(Pattern(140, 40, 1, 8)), b = Rounded(Pattern(140, 40, 2, 8));
  const ExposureRange range = {-4, 3, 5};
  const ExactPlane twin = flip_twin::HdrFlipMap(a, b, range, kDefaultPixelsPerDegree);
  ForEachTarget([&](Target) { CheckTwins(HdrFlipOf(a, b, range), twin); });
}

TEST_CASE("Equal pictures have no FLIP, nor has what is far from a difference", "[flip]") {
  const ExactPlanes picture = Pattern(300, 270, 1, 1);
  ExactPlanes dot = picture;
  for (ExactPlane& plane : dot) plane.at(150, 100) = 1 - plane.at(150, 100);
  const Plane map = FlipOf(picture, dot, 67);
  CHECK(map.at(150, 100) > 0.1);
  for (int y = 0; y < 270; ++y) {
    for (int x = 0; x < 300; ++x) {
      // The filters' radius is 10.
      if (std::max(std::abs(x - 150), std::abs(y - 100)) > 10) REQUIRE(map.at(x, y) == 0);
    }
  }
  const FloatPicture same(picture);
  for (const bool alike : {false, true}) {
    const ShowPair show = {{}, {}, alike};
    const Plane none = nacre::FlipMap(same.view, same.view, std::span(&show, 1), 67);
    CHECK(Largest(none) == 0);
  }
}

TEST_CASE("The FLIP of even colours is that of their distance", "[flip]") {
  // No features, and filters keep what is even. Black and white are 100 apart in L*, HyAB^0.7 is
  // 25.1189. Green is L* 87.735, a* -86.183, b* 83.179 (by Hunt -75.613 and 72.977), blue 32.297,
  // 79.188, -107.860 (25.575 and -34.836): 55.438 + 147.862 apart, ^0.7 is 41.2758. From 0.4 of
  // that, 16.5103, on, the last 0.05 of the scale: 0.95 + 0.05 (25.1189 - 16.5103) / 24.7655.
  // Five digits of the colours leave 1e-5 of the distances.
  const Plane white = FlipOf(Even(9, 0, 0, 0), Even(9, 1, 1, 1), 67);
  CHECK(white.at(4, 4) == Approx(0.967380).margin(1e-6));
  CHECK(FlipOf(Even(9, 0, 1, 0), Even(9, 0, 0, 1), 67).at(0, 0) == Approx(1).epsilon(1e-6));
  // Greys, below 16.5103: 0.95 / 16.5103 times (116 (cbrt 0.5 - cbrt 0.2))^0.7.
  const double between = 116 * (std::cbrt(0.5) - std::cbrt(0.2));
  CHECK(FlipOf(Even(3, 0.2, 0.2, 0.2), Even(3, 0.5, 0.5, 0.5), 67).at(1, 1) ==
        Approx(0.95 / 16.5103 * std::pow(between, 0.7)).epsilon(1e-5));
}

TEST_CASE("FLIP does not mind which picture is which", "[flip]") {
  const ExactPlanes a = Pattern(20, 12, 0, 1), b = Pattern(20, 12, 4, 1);
  const Plane forth = FlipOf(a, b, 40), back = FlipOf(b, a, 40);
  for (size_t i = 0; i < forth.size(); ++i) CHECK(forth.values[i] == back.values[i]);
}

TEST_CASE("FLIP grows with the difference of greys", "[flip]") {
  double last = 0;
  for (const double grey : {0.21, 0.25, 0.4, 0.7, 1.0}) {
    const double now = FlipOf(Even(5, 0.2, 0.2, 0.2), Even(5, grey, grey, grey), 67).at(2, 2);
    CHECK(now > last);
    last = now;
  }
}

TEST_CASE("A dot is seen where it is, and an edge more than the colours beside it", "[flip]") {
  ExactPlanes dot = Even(41, 0.2, 0.2, 0.2);
  for (ExactPlane& plane : dot) plane.at(20, 20) = 1;
  const Plane map = FlipOf(Even(41, 0.2, 0.2, 0.2), dot, 67);
  CHECK(map.at(20, 20) > 0.1);
  CHECK(map.at(0, 0) == 0);  // 20 pixels off: beyond both filters, of radius 10 and 9
  CHECK(map.at(19, 20) == Approx(map.at(21, 20)).epsilon(1e-6));
  CHECK(map.at(20, 19) == Approx(map.at(19, 20)).epsilon(1e-4));  // rows first, then columns
  // An edge: half the picture brighter. At the edge FLIP exceeds that of the even colours.
  ExactPlanes edge = Even(41, 0.2, 0.2, 0.2);
  for (ExactPlane& plane : edge) {
    for (int y = 0; y < 41; ++y) {
      for (int x = 21; x < 41; ++x) plane.at(x, y) = 0.4;
    }
  }
  const Plane step = FlipOf(Even(41, 0.2, 0.2, 0.2), edge, 67);
  CHECK(step.at(22, 20) > step.at(40, 20));
}

TEST_CASE("More pixels per degree hide a fine pattern", "[flip]") {
  ExactPlanes checks = Even(24, 0, 0, 0), greys = Even(24, 0.5, 0.5, 0.5);
  for (ExactPlane& plane : checks) {
    for (int y = 0; y < 24; ++y) {
      for (int x = 0; x < 24; ++x) plane.at(x, y) = (x + y) % 2;
    }
  }
  const double near = MeanOf(FlipOf(greys, checks, 20));
  const double far = MeanOf(FlipOf(greys, checks, 120));
  CHECK(far < 0.2 * near);
}

TEST_CASE("Exposures come from the reference, and black does not make them infinite", "[flip]") {
  // ACES(0.6 x) = 0.85: the root, put into the curve.
  ExactPlanes planes = Even(4, 1, 1, 1);
  const ExposureRange even = FlipExposures(FloatPicture(planes).view);
  const double shown = 0.6 * std::exp2(even.start);
  CHECK(shown * (2.51 * shown + 0.03) / (shown * (2.43 * shown + 0.59) + 0.14) ==
        Approx(0.85).epsilon(1e-12));
  CHECK((even.stop == even.start && even.count == 2));
  for (ExactPlane& plane : planes) plane.values.assign(16, 0.0);
  CHECK(FlipExposures(FloatPicture(planes).view).count == 1);
  // One of four rows is lit: 1, 2, 4, 8.
  for (ExactPlane& plane : planes) {
    for (int x = 0; x < 4; ++x) plane.at(x, 0) = std::ldexp(1, x);
  }
  const ExposureRange lit = FlipExposures(FloatPicture(planes).view);
  CHECK(lit.start == Approx(even.start - 3).epsilon(1e-12));              // 8
  CHECK(lit.stop == Approx(even.start - std::log2(3.0)).epsilon(1e-12));  // (2 + 4) / 2
  CHECK(lit.count == 2);
}

TEST_CASE("HDR-FLIP keeps the exposure that shows the most", "[flip]") {
  // Alike where dark, 100 and 200 where bright: white both at exposure 0, apart in the dark.
  ExactPlanes a = Even(3, 100, 100, 100), b = Even(3, 200, 200, 200);
  CHECK(HdrFlipOf(a, b, {-8, 0, 9}).at(1, 1) > 0.2);
  CHECK(HdrFlipOf(a, b, {-8, 0, 9}).at(1, 1) == HdrFlipOf(a, b, {-8, -4, 5}).at(1, 1));
  CHECK(HdrFlipOf(a, b, {0, 0, 1}).at(1, 1) == 0);
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
