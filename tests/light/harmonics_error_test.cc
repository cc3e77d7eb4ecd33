// SPDX-License-Identifier: Apache-2.0
// tests/light/harmonics_error_test.cc: an image's exact irradiance against quadrature and closed
// forms, and what harmonics are told to miss against what they are known to miss.
#include "light/harmonics_error.h"

#include <cmath>
#include <random>

#include "base/basis.h"
#include "catch.h"

namespace nacre {
namespace {

EnvironmentMap RandomMap(int width, int height) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Vec3f> texels;
  texels.reserve(static_cast<size_t>(width) * static_cast<size_t>(height));
  for (int i = 0; i < width * height; ++i) {
    const float red = unit(random), green = unit(random), blue = unit(random);
    texels.emplace_back(red, green, blue);
  }
  return MakeEnvironmentMap(width, height, texels);
}

// Black but for the texels that `lit` names, of radiance 1000.
template <class Lit>
EnvironmentMap LampMap(int width, int height, const Lit& lit) {
  std::vector<Vec3f> texels;
  texels.reserve(static_cast<size_t>(width) * static_cast<size_t>(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) texels.emplace_back(lit(x, y) ? 1000.0f : 0.0f);
  }
  return MakeEnvironmentMap(width, height, texels);
}

// By kSteps^2 directions, evenly by sin^2 and azimuth about the normal. Rings begin at azimuths of
// their own, for they would meet the same columns of texels all.
Vec3d Quadrature(const EnvironmentMap& map, const Vec3d& normal) {
  constexpr int kSteps = 1000;
  const Basis<double> basis = BasisAbout(normal);
  Vec3d sum(0);
  for (int i = 0; i < kSteps; ++i) {
    const double sin = std::sqrt((i + 0.5) / kSteps);
    for (int j = 0; j < kSteps; ++j) {
      const double phi = 2 * M_PI * (j + std::fmod(0.618033988749895 * i, 1.0)) / kSteps;
      const EnvironmentTexel texel =
          TexelAt(map, basis.ToWorld({sin * std::cos(phi), sin * std::sin(phi),
                                      std::sqrt((1 - sin) * (1 + sin))}));
      sum += Vec3d(texel.red, texel.green, texel.blue);
    }
  }
  return sum * (M_PI / (1.0 * kSteps * kSteps));
}

TEST_CASE("cells have the irradiance of the image's texels, whatever its size") {
  const Vec3d normals[] = {
      {0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {0.48, 0.6, -0.64}, {-0.6, 0.1, std::sqrt(0.63)}};
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(5, 3), std::pair(64, 32),
                                      std::pair(300, 200), std::pair(700, 300)}) {
    const EnvironmentMap map = RandomMap(width, height);
    const std::vector<LightCell> cells = MakeLightCells(map);
    CHECK(cells.size() >= size_t{128} * 256);
    for (const Vec3d& normal : normals) {
      CAPTURE(width, height, normal);
      const Vec3d exact = Quadrature(map, normal), got = Irradiance(cells, normal);
      // Cells on the horizon, 1.4 degrees wide, 1.5e-4 of a uniform sky's; and the quadrature's
      // steps at texels' edges.
      for (int c = 0; c < 3; ++c) CHECK(std::abs(got[c] / exact[c] - 1) <= 1e-3);
    }
  }
}

TEST_CASE("a uniform image has irradiance pi, from cells and from harmonics, which miss nothing") {
  const EnvironmentMap map = LampMap(48, 24, [](int, int) { return true; });
  CHECK(Irradiance(MakeLightCells(map), Vec3d(0.6, 0, 0.8)).x / 1000 == Approx(M_PI).epsilon(3e-4));
  const HarmonicsError error = MeasureHarmonics(map, ProjectIrradiance(map));
  CHECK(error.normals == 256);
  CHECK(error.worst <= 3e-4);  // the cells on the horizon
}

TEST_CASE("of a single lamp harmonics are told to miss what they miss") {
  // 0.094 of its light at normal incidence at most, at its terminator. The mean of the clamped
  // cosine over all normals is 1/4.
  const EnvironmentMap map = LampMap(256, 128, [](int x, int y) { return x == 77 && y == 41; });
  const HarmonicsError error = MeasureHarmonics(map, ProjectIrradiance(map));
  CHECK(error.worst == Approx(4 * 0.094).epsilon(0.05));  // 256 normals may pass the terminator by
  // The mean square over the sphere of order 2's difference from the cosine, by the midpoint rule.
  double squares = 0;
  constexpr int kSteps = 10000;
  for (int i = 0; i < kSteps; ++i) {
    const double c = 2 * (i + 0.5) / kSteps - 1;
    const double series = std::max(0.25 + c / 2 + 5.0 / 16 * (1.5 * c * c - 0.5), 0.0);
    squares += std::pow(series - std::max(c, 0.0), 2) / kSteps;
  }
  CHECK(error.rms == Approx(4 * std::sqrt(squares)).epsilon(0.05));
}

TEST_CASE("errors are measured per channel, and black images have none") {
  std::vector<Vec3f> texels(32 * 16, Vec3f(1, 0, 0));
  texels[100] = Vec3f(1, 50, 0);
  const EnvironmentMap map = MakeEnvironmentMap(32, 16, texels);
  // Green is a lamp alone; red would hide it in a mean of the channels.
  CHECK(MeasureHarmonics(map, ProjectIrradiance(map)).worst > 0.3);
  const EnvironmentMap black = MakeEnvironmentMap(2, 1, {Vec3f(0), Vec3f(0)});
  const HarmonicsError none = MeasureHarmonics(black, ProjectIrradiance(black));
  CHECK(none.worst == 0);
  CHECK(none.rms == 0);
}

TEST_CASE("harmonics and cells are the same on any number of threads") {
  const EnvironmentMap map = RandomMap(301, 157);
  const IrradianceHarmonics<double> one = ProjectIrradiance(map, 1),
                                    three = ProjectIrradiance(map, 3);
  CHECK(one.coefficients == three.coefficients);
  const HarmonicsError a = MeasureHarmonics(map, one, 1), b = MeasureHarmonics(map, one, 3);
  CHECK(a.rms == b.rms);
  CHECK(a.worst == b.worst);
}

}  // namespace
}  // namespace nacre
