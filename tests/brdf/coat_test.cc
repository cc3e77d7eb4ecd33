// SPDX-License-Identifier: Apache-2.0
// tests/brdf/coat_test.cc: clear coat: its albedo against quadratures, what is above and below it
// adds up to all light, how it differs from KHR_materials_clearcoat, and the SIMD twins.
#include "brdf/coat.h"

#include <cmath>
#include <random>

#include "brdf/albedo_integral.h"
#include "brdf/layer_kernel.h"
#include "brdf/lobe_sampling.h"
#include "catch.h"
#include "tables.h"
#include "targets.h"

namespace nacre {
namespace {

const double kCoatRoughnesses[] = {0, 1e-3, 0.02, 0.1, 0.3, 0.5, 0.7, 1};
const double kCoatCosines[] = {1e-4, 1e-3, 0.01, 0.05, 0.1, 0.3, 0.5, 0.8, 1};
const Vec3d kUp(0, 0, 1);

Vec3d CoatDirection(double cos, double phi) {
  const double sin = std::sqrt((1 - cos) * (1 + cos));
  return {sin * std::cos(phi), sin * std::sin(phi), cos};
}

// int F(v.h) D V n.l dl with Schlick's F.
double TrueCoatAlbedo(double roughness, double f0, double n_dot_v) {
  return AlbedoOf(
      Shadowing::kHeightCorrelated, roughness, n_dot_v,
      [&](double, double one_minus_vh) { return FresnelSchlick(f0, Power5(one_minus_vh)); });
}

TEST_CASE("a coat and what is white below it reflect all light") {
  for (const double ior : {1.3, 1.5, 2.0}) {
    const double f0 = FresnelF0(ior, 0.0);
    for (const double roughness : kCoatRoughnesses) {
      const AlbedoFit fit = MakeAlbedoFit(Shadowing::kHeightCorrelated, roughness);
      for (const double n_dot_v : kCoatCosines) {
        for (const double amount : {1.0, 0.3, 0.0}) {
          CAPTURE(ior, roughness, n_dot_v, amount);
          const double coat = amount * TrueCoatAlbedo(roughness, f0, n_dot_v);
          const double below = ScaleBelowCoat(amount, CoatAlbedo(fit, f0, n_dot_v));
          CHECK(below >= 0);
          CHECK(std::abs(coat + below - 1) <= 5e-5);  // the fits' error
          if (amount == 0) CHECK(below == 1);
        }
      }
    }
  }
  CHECK(FresnelF0(1.5, 0.0) == Approx(kDielectricF0).epsilon(1e-15));
}

TEST_CASE("the coat's lobe is its albedo, sampled by visible normals") {
  constexpr int kSteps = 300;
  for (const double roughness : {0.1, 0.4, 1.0}) {
    const double alpha = roughness * roughness;
    for (const double n_dot_v : {0.1, 0.6}) {
      CAPTURE(roughness, n_dot_v);
      const Vec3d v = CoatDirection(n_dot_v, 0.4);
      double sum = 0;
      for (int i = 0; i < kSteps * kSteps; ++i) {
        const double u0 = (i / kSteps + 0.5) / kSteps, root = (i % kSteps + 0.5) / kSteps;
        const Vec3d l = SampleGgxVisible(kUp, v, alpha, u0, 1 - root * root);
        const Angles<double> a = ComputeAngles(kUp, l, v);
        if (!(a.n_dot_l > 0)) continue;
        sum += 2 * root * CoatLobe(a, 0.04, alpha) * a.n_dot_l / GgxVisiblePdf(a, alpha);
      }
      CHECK(std::abs(sum / (kSteps * kSteps) - TrueCoatAlbedo(roughness, 0.04, n_dot_v)) <= 1e-4);
    }
  }
}

TEST_CASE("a smooth coat is a mirror by the Fresnel term of the normal, exactly") {
  const AlbedoFit fit = MakeAlbedoFit(Shadowing::kHeightCorrelated, 0);
  for (const double n_dot_v : {0.0, 1e-9, 0.01, 0.3, 0.9, 1.0}) {
    const double fresnel = FresnelSchlick(0.04, Power5(1 - n_dot_v));
    CHECK(CoatAlbedo(fit, 0.04, n_dot_v) == Approx(fresnel).epsilon(1e-14));
    CHECK(ScaleBelowCoat(0.7, CoatAlbedo(fit, 0.04, n_dot_v)) ==
          Approx(1 - 0.7 * fresnel).epsilon(1e-14));
  }
  const Angles<double> a = ComputeAngles(kUp, CoatDirection(0.5, M_PI), CoatDirection(0.5, 0));
  CHECK(CoatLobe(a, 0.04, 0.0) == 0);
}

TEST_CASE("the coat's lobe is finite, reciprocal, and dark below the surface") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 10000; ++i) {
    const Vec3d l = CoatDirection(std::pow(unit(random), 4), 6 * unit(random));
    const Vec3d v = CoatDirection(std::pow(unit(random), 4), 6 * unit(random));
    const double alpha = 0.01 + unit(random);
    const double value = CoatLobe(ComputeAngles(kUp, l, v), 0.04, alpha);
    if (!std::isfinite(value) || !(value > 0)) FAIL("not positive");
    const double other = CoatLobe(ComputeAngles(kUp, v, l), 0.04, alpha);
    if (std::abs(value - other) > 1e-11 * value) FAIL("not reciprocal: " << value - other);
    if (CoatLobe(ComputeAngles(kUp, -l, v), 0.04, alpha) != 0) FAIL("light from below");
    if (CoatLobe(ComputeAngles(kUp, l, -v), 0.04, alpha) != 0) FAIL("seen from below");
  }
}

// KHR_materials_clearcoat: f_below (1 - c F(n.v)) + c F(n.v) D V.
struct KhrCoat {
  double below, lobe;
};
KhrCoat MakeKhrCoat(const Angles<double>& a, double amount, double alpha) {
  const double fresnel = amount * FresnelSchlick(0.04, Power5(1 - a.n_dot_v));
  return {1 - fresnel, fresnel * GgxDistribution(a, alpha) *
                           VisibilityHeightCorrelated(a.n_dot_l, a.n_dot_v, alpha)};
}

TEST_CASE("the coat differs from KHR_materials_clearcoat by the angle of its Fresnel term") {
  // In the mirror direction v.h is n.v.
  for (const double n_dot_v : {0.1, 0.5, 1.0}) {
    const Angles<double> a =
        ComputeAngles(kUp, CoatDirection(n_dot_v, M_PI), CoatDirection(n_dot_v, 0));
    CHECK(CoatLobe(a, 0.04, 0.25) == Approx(MakeKhrCoat(a, 1, 0.25).lobe).epsilon(1e-12));
  }
  // Elsewhere by F(v.h) / F(n.v). Light from the zenith, seen at 84 degrees: v.h is 0.74.
  const Angles<double> a = ComputeAngles(kUp, kUp, CoatDirection(0.1, 0));
  const double ratio =
      FresnelSchlick(0.04, SchlickWeight(a)) / FresnelSchlick(0.04, Power5(1 - a.n_dot_v));
  CHECK(ratio < 0.1);
  CHECK(CoatLobe(a, 0.04, 0.25) == Approx(ratio * MakeKhrCoat(a, 1, 0.25).lobe).epsilon(1e-12));

  // White under a coat of roughness 1 and amount 1: 1 - F(n.v) (1 - E(n.v)) of the light by KHR,
  // all of it here. Under smooth coats both are all.
  for (const double n_dot_v : {0.02, 0.1, 0.5, 1.0}) {
    const double e = AlbedoOfOne(Shadowing::kHeightCorrelated, 1, n_dot_v);
    const double fresnel = FresnelSchlick(0.04, Power5(1 - n_dot_v));
    const double khr = (1 - fresnel) + fresnel * e;
    const AlbedoFit fit = MakeAlbedoFit(Shadowing::kHeightCorrelated, 1);
    const double ours =
        ScaleBelowCoat(1.0, CoatAlbedo(fit, 0.04, n_dot_v)) + TrueCoatAlbedo(1, 0.04, n_dot_v);
    CAPTURE(n_dot_v, khr, ours);
    CHECK(std::abs(ours - 1) <= 5e-5);
    CHECK(khr < ours);
    if (n_dot_v == 0.1) CHECK(khr == Approx(0.854).margin(5e-4));
  }
}

template <typename T>
void CheckCoatTwins(double unit_roundoff) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<LayerQuery<T>> queries;
  for (int i = 0; i < 4000; ++i) {
    LayerQuery<T> q;
    q.n = Imath::Vec3<T>(kUp);
    q.l = Imath::Vec3<T>(CoatDirection(std::pow(unit(random), 2) - 0.1, 6 * unit(random)));
    q.v = Imath::Vec3<T>(CoatDirection(std::pow(unit(random), 2), 6 * unit(random)));
    q.roughness = static_cast<T>(i % 50 == 0 ? 0.0 : 0.05 + 0.95 * unit(random));
    q.f0 = static_cast<T>(unit(random));
    queries.push_back(q);
  }
  const auto answers = EvaluateLayers(RoughnessOf::kEach, queries);
  double lobe = 0, albedo = 0, below = 0;
  for (size_t i = 0; i < queries.size(); ++i) {
    const LayerQuery<T>& q = queries[i];
    const double alpha = AlphaFromRoughness(double{q.roughness}), f0 = q.f0;
    const Angles<double> a = ComputeAngles(Vec3d(q.n), Vec3d(q.l), Vec3d(q.v));
    const double want = CoatLobe(a, f0, alpha);
    if (want == 0) {
      CHECK(answers[i].coat == 0);
    } else {
      // Half vectors are known to a rounding over |u|, and the lobe is alpha wide.
      const double rounding = unit_roundoff * (64 + 16 / alpha) * (1 + 1 / std::sqrt(a.u_squared));
      lobe = std::max(lobe, std::abs(answers[i].coat / want - 1) / rounding);
    }
    const AlbedoFit fit = MakeAlbedoFit(Shadowing::kHeightCorrelated, double{q.roughness});
    const double e = CoatAlbedo(fit, f0, double{q.v.z});
    albedo = std::max(albedo, std::abs(answers[i].coat_albedo - e));
    below = std::max(below, std::abs(answers[i].below_coat - ScaleBelowCoat(0.5, e)));
  }
  CHECK(lobe <= 1);
  // The polynomials' coefficients sum to less than 50.
  CHECK(albedo <= 64 * unit_roundoff);
  CHECK(below <= 64 * unit_roundoff);
}

TEST_CASE("SIMD coats are their double twins on every target, in floats and in doubles") {
  ForEachTarget([](Target) {
    CheckCoatTwins<float>(kHalfUlpFloat);
    CheckCoatTwins<double>(kHalfUlpDouble);
  });
}

}  // namespace
}  // namespace nacre
