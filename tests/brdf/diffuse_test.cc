// SPDX-License-Identifier: Apache-2.0
// tests/brdf/diffuse_test.cc: diffuse models: the energy that they keep or are known to make,
// reciprocity, their limits, and the SIMD twins.
#include <cmath>
#include <random>

#include "brdf/burley.h"
#include "brdf/diffuse_kernel.h"
#include "brdf/eon.h"
#include "catch.h"
#include "targets.h"

namespace nacre {
namespace {

const Vec3d kNormal(0, 0, 1);

Vec3d DirectionAt(double cos, double phi) {
  const double sin = std::sqrt((1 - cos) * (1 + cos));
  return {sin * std::cos(phi), sin * std::sin(phi), cos};
}

// The share of light from v that a BRDF gives back: the midpoint rule in azimuth and in x, cos =
// x^3, which is densest where models have kinks and peaks, at the horizon.
template <class Brdf>
double DirectionalAlbedo(const Brdf& brdf, double n_dot_v) {
  constexpr int kSteps = 400;
  const Vec3d v = DirectionAt(n_dot_v, 0.4);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = (i + 0.5) / kSteps, cos = x * x * x;
    for (int j = 0; j < kSteps; ++j) {
      const Vec3d l = DirectionAt(cos, 2 * M_PI * (j + 0.5) / kSteps);
      sum += brdf(ComputeAngles(kNormal, l, v)) * cos * 3 * x * x;
    }
  }
  return sum * 2 * M_PI / (1.0 * kSteps * kSteps);
}

// EON's, in closed form.
double EonDirectionalAlbedo(double n_dot_v, double albedo, double roughness) {
  const double loss = EonScale(roughness) * roughness * EonLoss(n_dot_v);
  return albedo * (1 - loss) + EonMultipleAlbedo(albedo, roughness) * loss;
}

const double kRoughnesses[] = {0, 0.01, 0.1, 0.3, 0.5, 0.8, 1};
const double kCosines[] = {1, 0.8, 0.5, 0.2, 0.05, 1e-3};

TEST_CASE("a white EON surface gives back all light") {
  for (const double roughness : kRoughnesses) {
    for (const double n_dot_v : kCosines) {
      CAPTURE(roughness, n_dot_v);
      const double got = DirectionalAlbedo(
          [&](const Angles<double>& a) { return Eon(a, 1.0, roughness); }, n_dot_v);
      CHECK(std::abs(got - 1) <= 1e-4);  // the rule's error: the model's is none
      CHECK(EonDirectionalAlbedo(n_dot_v, 1.0, roughness) == Approx(1).epsilon(1e-14));
    }
  }
}

TEST_CASE("EON's directional albedo is its integral") {
  for (const double roughness : kRoughnesses) {
    for (const double albedo : {0.0, 0.18, 0.9}) {
      for (const double n_dot_v : kCosines) {
        CAPTURE(roughness, albedo, n_dot_v);
        const double got = DirectionalAlbedo(
            [&](const Angles<double>& a) { return Eon(a, albedo, roughness); }, n_dot_v);
        CHECK(std::abs(got - EonDirectionalAlbedo(n_dot_v, albedo, roughness)) <= 1e-4);
      }
    }
  }
}

TEST_CASE("EON at roughness 0 is Lambert's, and its mean loss is that of all angles") {
  for (const double n_dot_l : kCosines) {
    const Angles<double> a = ComputeAngles(kNormal, DirectionAt(n_dot_l, 1), DirectionAt(0.3, 2));
    CHECK(Eon(a, 0.7, 0.0) == Approx(0.7 / M_PI).epsilon(1e-15));
  }
  CHECK(std::abs(EonLoss(0.0)) <= 1e-16);  // grazing light all comes back
  double mean = 0;
  for (int i = 0; i < 100000; ++i) {
    const double cos = (i + 0.5) / 100000;
    mean += EonLoss(cos) * 2 * cos / 100000;
  }
  CHECK(mean == Approx(kEonAlbedo - kEonMeanAlbedo).epsilon(1e-8));
}

TEST_CASE(
    "Burley's diffuse term is 1 / pi along the normal, and makes light where it is known to") {
  const Angles<double> along = ComputeAngles(kNormal, kNormal, kNormal);
  CHECK(BurleyDiffuse(along, 0.3) == Approx(1 / M_PI).epsilon(1e-15));
  // Both grazing, back towards the light: (1/2 + 2 roughness)^2. Away from it: 1/4.
  const Vec3d grazing = DirectionAt(1e-9, 0);
  CHECK(BurleyDiffuse(ComputeAngles(kNormal, grazing, grazing), 1.0) * M_PI ==
        Approx(6.25).epsilon(1e-6));
  CHECK(BurleyDiffuse(ComputeAngles(kNormal, grazing, DirectionAt(1e-9, M_PI)), 1.0) * M_PI ==
        Approx(0.25).epsilon(1e-6));
  const auto albedo = [](double roughness, double n_dot_v) {
    return DirectionalAlbedo([&](const Angles<double>& a) { return BurleyDiffuse(a, roughness); },
                             n_dot_v);
  };
  CHECK(albedo(0, 1) < 1);
  // By hand in the limit: the integrals are Beta functions, of (2, 6) and (4, 6).
  const double b26 = 1.0 / 42, b46 = 6.0 * 120 / 362880;
  CHECK(std::abs(albedo(0, 1e-7) - (1 - b26) / 2) <= 1e-4);
  CHECK(std::abs(albedo(1, 1e-7) - (1.5 + 1.5 * b26 + b26 - b46)) <= 1e-4);
  for (const double roughness : kRoughnesses) {
    CHECK(std::abs(albedo(roughness, 1e-7) - BurleyGrazingAlbedo(roughness)) <= 1e-4);
  }
  CHECK(BurleyGrazingAlbedo(0.49) < 1);
  CHECK(BurleyGrazingAlbedo(0.5) > 1);
}

TEST_CASE("diffuse models are reciprocal, positive and dark below the surface") {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 10000; ++i) {
    const Vec3d l = DirectionAt(unit(random), 6 * unit(random));
    const Vec3d v = DirectionAt(unit(random), 6 * unit(random));
    const double roughness = unit(random), albedo = unit(random);
    const Angles<double> a = ComputeAngles(kNormal, l, v), b = ComputeAngles(kNormal, v, l);
    const double eon = Eon(a, albedo, roughness), burley = BurleyDiffuse(a, roughness);
    if (!(eon > 0) || !(burley > 0)) FAIL("not positive");
    if (std::abs(eon - Eon(b, albedo, roughness)) > 16 * 0x1p-53 * eon) FAIL("EON " << i);
    if (std::abs(burley - BurleyDiffuse(b, roughness)) > 16 * 0x1p-53 * burley) FAIL("Burley");
    const Angles<double> below = ComputeAngles(kNormal, -l, v);
    if (Eon(below, albedo, roughness) != 0 || BurleyDiffuse(below, roughness) != 0) FAIL("below");
  }
}

TEST_CASE("SIMD diffuse models agree with their double twins on every target") {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<DiffuseQuery> queries;
  for (int i = 0; i < 10000; ++i) {
    const Vec3d l = DirectionAt(2 * unit(random) - 1, 6 * unit(random));
    const Vec3d v = DirectionAt(std::max(unit(random), 1e-3), 6 * unit(random));
    queries.push_back({Vec3f(kNormal), Vec3f(l), Vec3f(v), static_cast<float>(unit(random)),
                       static_cast<float>(unit(random))});
  }
  ForEachTarget([&](Target) {
    const std::vector<DiffuseAnswer> answers = EvaluateDiffuse(queries);
    double eon = 0, burley = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
      const DiffuseQuery& q = queries[i];
      const Angles<double> a =
          ComputeAngles(Vec3d(q.n), Vec3d(q.l).normalized(), Vec3d(q.v).normalized());
      const double roughness = q.roughness, albedo = q.albedo;
      // s / t has the rounding of l.v over the larger cosine.
      const double scale = 1 / std::max({a.n_dot_l, a.n_dot_v, 1e-3});
      const double want = Eon(a, albedo, roughness), want_burley = BurleyDiffuse(a, roughness);
      if (want == 0) CHECK(answers[i].eon == 0);
      eon = std::max(eon, std::abs(answers[i].eon - want) / (want + 1e-30) / scale);
      burley = std::max(burley, std::abs(answers[i].burley - want_burley));
    }
    CHECK(eon <= 4e-6);
    CHECK(burley <= 1e-6);
  });
}

}  // namespace
}  // namespace nacre
