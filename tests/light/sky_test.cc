// SPDX-License-Identifier: Apache-2.0
// tests/light/sky_test.cc: skies by formula against the table and quadrature, and the SIMD
// twins.
#include "light/sky.h"

#include <cmath>
#include <random>

#include "base/basis.h"
#include "catch.h"
#include "light/environment_kernel.h"
#include "tables.h"
#include "targets.h"

namespace nacre {
namespace {

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

TEST_CASE("quadratic skies match the table, in closed form", "[table]") {
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
    ++rows;
  }
  CHECK(rows > 0);
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
        Approx(2 * M_PI).epsilon(1e-15));
}

}  // namespace
}  // namespace nacre
