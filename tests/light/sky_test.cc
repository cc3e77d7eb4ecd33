// SPDX-License-Identifier: Apache-2.0
// tests/light/sky_test.cc: skies by formula against the table and quadrature, irradiance from
// spherical harmonics against both, and the SIMD twins.
#include "light/sky.h"

#include <cmath>
#include <random>

#include "base/basis.h"
#include "catch.h"
#include "light/environment_kernel.h"
#include "light/harmonics.h"
#include "tables.h"
#include "targets.h"

namespace nacre {
namespace {

Vec3d TableVector(const nlohmann::json& value) {
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

std::vector<Vec3d> SomeNormals() {
  std::vector<Vec3d> normals = {{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {0, 0, -1}};
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 40; ++i) {
    const double x = normal(random), y = normal(random), z = normal(random);
    normals.push_back(Vec3d(x, y, z).normalized());
  }
  return normals;
}

// An image whose texels are the radiance at their centres.
template <class Radiance>
EnvironmentMap MapOf(int width, int height, const Radiance& radiance) {
  std::vector<Vec3f> texels;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Vec3d centre = DirectionFromLatLong((x + 0.5) / width, (y + 0.5) / height);
      texels.emplace_back(static_cast<float>(radiance(centre)));
    }
  }
  return MakeEnvironmentMap(width, height, texels);
}

// The irradiance by the midpoint rule over the hemisphere, in equal steps of sin^2 and azimuth, in
// which cosine and solid angle are constant.
template <class Radiance>
double Integrate(const Radiance& radiance, const Vec3d& normal, int steps) {
  const Basis<double> basis = BasisAbout(normal);
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double sin = std::sqrt((i + 0.5) / steps);
    for (int j = 0; j < steps; ++j) {
      const double phi = 2 * M_PI * (j + 0.5) / steps;
      sum += radiance(basis.ToWorld(
          {sin * std::cos(phi), sin * std::sin(phi), std::sqrt((1 - sin) * (1 + sin))}));
    }
  }
  return sum * M_PI / (1.0 * steps * steps);
}

TEST_CASE("quadratic skies match the table, in closed form and from harmonics", "[table]") {
  const nlohmann::json table = LoadTable("environment_irradiance");
  size_t rows = 0;
  for (const auto& row : table.at("rows")) {
    const Vec3d normal = TableVector(row["n"]).normalized();
    const QuadraticSkyTerms<double> sky{TableVector(row["s"]).normalized(), row["a0"].get<double>(),
                                        row["a1"].get<double>(), row["a2"].get<double>()};
    const double reference = TableNumber(row["E"]);
    CAPTURE(rows, reference);
    CHECK(std::abs(Irradiance(sky, normal) / reference - 1) <= 1e-14);
    const QuadraticSkyTerms<float> rounded{Vec3f(sky.axis), static_cast<float>(sky.a0),
                                           static_cast<float>(sky.a1), static_cast<float>(sky.a2)};
    ForEachTarget([&](Target) {
      const double got = EvaluateSky(rounded, {Vec3f(normal)})[0].y;
      CHECK(std::abs(got / reference - 1) <= 1e-6);  // tables/README: 1e-5
    });
    // Harmonics to order 2 hold such a sky exactly: what is left is the image's texels.
    const EnvironmentMap map =
        MapOf(128, 64, [&](const Vec3d& direction) { return Radiance(sky, direction); });
    CHECK(std::abs(Irradiance(ProjectIrradiance(map), normal).x / reference - 1) <= 1e-3);
    ++rows;
  }
  CHECK(rows == 16);
}

TEST_CASE("gradient skies have their integral as irradiance") {
  const GradientSkyTerms<double> sky{0.2, 1.5, 0.6};
  const GradientSkyTerms<float> rounded{0.2f, 1.5f, 0.6f};
  for (const Vec3d& normal : SomeNormals()) {
    CAPTURE(normal);
    const double exact = Irradiance(sky, normal);
    // The midpoint rule over a kink at the horizon: the steps' square.
    const double integral =
        Integrate([&](const Vec3d& direction) { return Radiance(sky, direction); }, normal, 400);
    CHECK(std::abs(integral / exact - 1) <= 2e-5);
    ForEachTarget([&](Target) {
      const Vec3f got = EvaluateSky(rounded, {Vec3f(normal)})[0];
      CHECK(std::abs(got.x - Radiance(sky, normal)) <= 1e-6);
      CHECK(std::abs(got.y / exact - 1) <= 1e-6);
    });
  }
  CHECK(Irradiance(GradientSkyTerms<double>{2, 2, 2}, {0.6, 0, 0.8}) ==
        Approx(ConstantSkyIrradiance(2.0)).epsilon(1e-15));
}

TEST_CASE("harmonics are orthonormal") {
  constexpr int kSteps = 200;
  double products[kHarmonics][kHarmonics] = {};
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double z = 2 * (i + 0.5) / kSteps - 1, phi = 2 * M_PI * (j + 0.5) / kSteps;
      const double r = std::sqrt(1 - z * z);
      const HarmonicBasis<double> basis =
          EvaluateHarmonics<double>({r * std::cos(phi), r * std::sin(phi), z});
      for (size_t a = 0; a < kHarmonics; ++a) {
        for (size_t b = 0; b < kHarmonics; ++b) {
          products[a][b] += basis[a] * basis[b] * 4 * M_PI / (kSteps * kSteps);
        }
      }
    }
  }
  for (size_t a = 0; a < kHarmonics; ++a) {
    for (size_t b = 0; b < kHarmonics; ++b) {
      // The midpoint rule of z^4 in 200 steps.
      CHECK(std::abs(products[a][b] - (a == b)) <= 2e-4);
    }
  }
}

TEST_CASE("harmonics miss little of a sky, and 0.094 of a sun at its terminator") {
  const GradientSkyTerms<double> sky{0.2, 1.5, 0.6};
  const IrradianceHarmonics<double> of_sky = ProjectIrradiance(
      MapOf(128, 64, [&](const Vec3d& direction) { return Radiance(sky, direction); }));
  const Vec3d sun = Vec3d(0.3, 0.4, -0.7).normalized();
  const IrradianceHarmonics<double> of_sun = ProjectIrradiance(MapOf(
      512, 256, [&](const Vec3d& direction) { return (direction ^ sun) > 0.9995 ? 1000 : 0; }));
  const double solid_angle = Irradiance(of_sun, sun).x / 1.0625;  // what order 2 makes of its peak
  double sky_error = 0, sun_error = 0;
  for (const Vec3d& normal : SomeNormals()) {
    sky_error =
        std::max(sky_error, std::abs(Irradiance(of_sky, normal).x / Irradiance(sky, normal) - 1));
    const double cosine = std::max(normal ^ sun, 0.0);
    sun_error = std::max(sun_error, std::abs(Irradiance(of_sun, normal).x / solid_angle - cosine));
  }
  const Vec3d terminator = BasisAbout(sun).x;
  sun_error = std::max(sun_error, Irradiance(of_sun, terminator).x / solid_angle);
  CHECK(sky_error > 1e-4);  // it is an approximation
  CHECK(sky_error <= 0.02);
  CHECK(sun_error == Approx(0.094).margin(2e-3));
}

TEST_CASE("SIMD harmonics agree with their double twins on every target") {
  const EnvironmentMap map = MapOf(32, 16, [](const Vec3d& d) { return 1 + d.x + 3 * d.y * d.z; });
  const IrradianceHarmonics<double> exact = ProjectIrradiance(map);
  IrradianceHarmonics<float> rounded;
  for (size_t i = 0; i < kHarmonics; ++i) rounded.coefficients[i] = Vec3f(exact.coefficients[i]);
  std::vector<Vec3f> normals;
  for (const Vec3d& normal : SomeNormals()) normals.emplace_back(normal);
  ForEachTarget([&](Target) {
    const std::vector<Vec3f> got = EvaluateIrradiance(rounded, normals);
    for (size_t i = 0; i < normals.size(); ++i) {
      const Vec3d want = Irradiance(exact, Vec3d(normals[i]));
      CHECK((Vec3d(got[i]) - want).length() <= 5e-6);
    }
  });
}

}  // namespace
}  // namespace nacre
