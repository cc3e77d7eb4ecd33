// SPDX-License-Identifier: Apache-2.0
// tests/light/prefilter_test.cc: images blurred by lobes against quadrature of the lobe itself.
#include "light/prefilter.h"

#include <cmath>
#include <random>

#include "base/basis.h"
#include "brdf/ggx.h"
#include "catch.h"

namespace nacre {
namespace {

// Smooth enough for quadrature, of a size that the parts do not divide.
EnvironmentMap SomeMap() {
  constexpr int kWidth = 150, kHeight = 75;
  std::vector<Vec3f> texels;
  texels.reserve(size_t{kWidth} * kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Vec3d d = DirectionFromLatLong((x + 0.5) / kWidth, (y + 0.5) / kHeight);
      texels.emplace_back(Vec3d(d.x > 0.8 ? 5 : 0.2, 1 + d.y, 1 + d.x * d.z));
    }
  }
  return MakeEnvironmentMap(kWidth, kHeight, texels);
}

// Mirror directions of normals that are drawn by D n.h from a view along the normal, weighted by
// n.l: by midpoints.
Vec3d Quadrature(const EnvironmentMap& map, const Vec3d& mirror, double alpha) {
  constexpr int kSteps = 600;
  const Basis<double> basis = BasisAbout(mirror);
  Vec3d sum(0);
  double weights = 0;
  for (int i = 0; i < kSteps; ++i) {
    // tan^2 = alpha^2 u / (1 - u) for D n.h (Walter et al. 2007, eq. 35).
    const double u = (i + 0.5) / kSteps, half = std::atan(alpha * std::sqrt(u / (1 - u)));
    const double cosine = std::cos(2 * half), sine = std::sin(2 * half);
    if (!(cosine > 0)) continue;
    for (int j = 0; j < kSteps; ++j) {
      const double phi = 2 * M_PI * (j + 0.5) / kSteps;
      const EnvironmentTexel texel =
          TexelAt(map, basis.ToWorld({sine * std::cos(phi), sine * std::sin(phi), cosine}));
      sum += Vec3d(texel.red, texel.green, texel.blue) * cosine;
      weights += cosine;
    }
  }
  return sum / weights;
}

TEST_CASE("prefiltered images are the image under the lobe") {
  const EnvironmentMap map = SomeMap();
  const Vec3d directions[] = {{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {0.48, 0.6, -0.64}, {-0.6, 0, 0.8}};
  for (const double alpha : {kLeastPrefilterAlpha, 0.25, 1.0}) {
    const PrefilteredMap filtered = Prefilter(map, alpha);
    for (const Vec3d& direction : directions) {
      CAPTURE(alpha, direction);
      const Vec3d exact = Quadrature(map, direction, alpha), got = LookUp(filtered, direction);
      // Parts of 2.8 degrees under a lobe 10 degrees wide and more.
      for (int c = 0; c < 3; ++c) CHECK(std::abs(got[c] / exact[c] - 1) <= 0.02);
    }
  }
}

TEST_CASE("a uniform image stays so under every lobe, and in every direction") {
  const PrefilteredMap filtered =
      Prefilter(MakeEnvironmentMap(3, 2, std::vector<Vec3f>(6, Vec3f(2, 3, 4))), 0.3);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    const double x = normal(random), y = normal(random), z = normal(random);
    const Vec3d got = LookUp(filtered, Vec3d(x, y, z).normalized());
    CHECK((got - Vec3d(2, 3, 4)).length() <= 1e-5);  // sums of 8192 floats
  }
}

TEST_CASE("prefiltered images are the same on any number of threads") {
  const EnvironmentMap map = SomeMap();
  CHECK(Prefilter(map, 0.5, 1).texels == Prefilter(map, 0.5, 3).texels);
}

}  // namespace
}  // namespace nacre
