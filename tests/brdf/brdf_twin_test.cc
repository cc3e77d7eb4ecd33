// SPDX-License-Identifier: Apache-2.0
// tests/brdf/brdf_twin_test.cc: SIMD terms against their scalar double twins on random
// directions, and the limits that both must keep.
#include <cmath>
#include <random>

#include "brdf/fresnel.h"
#include "brdf/ggx.h"
#include "brdf/phong.h"
#include "brdf/term_kernel.h"
#include "catch.h"
#include "targets.h"

namespace nacre {
namespace {

// A uniform direction on the upper hemisphere about z.
Vec3d RandomUpper(std::mt19937* random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double z = unit(*random);
  const double phi = 2 * M_PI * unit(*random);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

// Directions rotated from n = +z into a general position, so that no component is special.
struct Frame {
  Vec3d x, y, z;
  Vec3d Apply(const Vec3d& v) const { return x * v.x + y * v.y + z * v.z; }
};

Frame RandomFrame(std::mt19937* random) {
  const Vec3d z = RandomUpper(random);
  const Vec3d x = (std::abs(z.x) < 0.9 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)).cross(z).normalized();
  return {x, z % x, z};
}

// v: random, or near the mirror direction of l for smooth surfaces, where their highlight is.
std::vector<TermInput> RandomInputs(double roughness, double shininess, double spread) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<TermInput> inputs;
  for (int i = 0; i < 20000; ++i) {
    const Frame frame = RandomFrame(&random);
    const Vec3d l = RandomUpper(&random);
    Vec3d v = RandomUpper(&random);
    if (spread > 0) {
      const Vec3d offset{normal(random), normal(random), normal(random)};
      v = (Vec3d(-l.x, -l.y, l.z) + offset * spread).normalized();
    }
    // Grazing beyond 1e-3 tests the rounding of the inputs, not the kernels.
    if (v.z < 1e-3 || l.z < 1e-3) continue;
    inputs.push_back({Vec3f(frame.z), Vec3f(frame.Apply(l)), Vec3f(frame.Apply(v)),
                      static_cast<float>(shininess), static_cast<float>(roughness), 0.04f});
  }
  return inputs;
}

struct MaxErrors {
  double phong = 0, blinn = 0, distribution = 0, height_correlated = 0, separable = 0,
         schlick_direct = 0, schlick_ibl = 0, fresnel = 0;
};

void Raise(double* maximum, double got, double reference) {
  if (reference < 1e-30) return;  // tails next to float's end
  *maximum = std::max(*maximum, std::abs(got / reference - 1));
}

// The bound of the relative error of Phong's lobe c^n. The error of c = 1 - |r - v|^2 / 2 is |r -
// v| times that of r - v, which is 10 u, u = 2^-24: the normal's length is off by u, which enters r
// four times, n.l by 2 u, which enters it twice, and the components of r by 2 u. To this come
// Log2's relative error of 2e-7, Exp2's of 1e-7 and the roundings around them.
double PhongBound(const Vec3d& n, const Vec3d& l, const Vec3d& v, double shininess) {
  const double off = (Mirrored(l, n) - v).length();
  const double c = 1 - off * off / 2;
  return 0x1p-24 * (10 * shininess * off / c - 4 * shininess * std::log(c) + 4);
}

// Largest relative errors, Phong's as a share of its bound, against the twins on the same,
// float-rounded inputs.
MaxErrors Measure(const std::vector<TermInput>& inputs) {
  MaxErrors errors;
  const std::vector<TermOutput> outputs = EvaluateTerms(inputs);
  for (size_t i = 0; i < inputs.size(); ++i) {
    const TermInput& in = inputs[i];
    const Vec3d n = Vec3d(in.n).normalized();
    const Vec3d l = Vec3d(in.l).normalized();
    const Vec3d v = Vec3d(in.v).normalized();
    const Angles<double> a = ComputeAngles(n, l, v);
    const double roughness = in.roughness;
    const double alpha = AlphaFromRoughness(roughness);
    const double shininess = in.shininess;
    double phong = 0;
    Raise(&phong, outputs[i].phong, PhongLobe(n, l, v, shininess));
    errors.phong = std::max(phong / PhongBound(n, l, v, shininess), errors.phong);
    Raise(&errors.blinn, outputs[i].blinn, BlinnLobe(a, shininess));
    Raise(&errors.distribution, outputs[i].distribution, GgxDistribution(a, alpha));
    Raise(&errors.height_correlated, outputs[i].height_correlated,
          VisibilityHeightCorrelated(a.n_dot_l, a.n_dot_v, alpha));
    Raise(&errors.separable, outputs[i].separable,
          VisibilitySeparable(a.n_dot_l, a.n_dot_v, alpha));
    Raise(&errors.schlick_direct, outputs[i].schlick_direct,
          VisibilitySchlick(a.n_dot_l, a.n_dot_v, SchlickK(Shadowing::kSchlickDirect, roughness)));
    Raise(&errors.schlick_ibl, outputs[i].schlick_ibl,
          VisibilitySchlick(a.n_dot_l, a.n_dot_v, SchlickK(Shadowing::kSchlickIbl, roughness)));
    Raise(&errors.fresnel, outputs[i].fresnel, FresnelSchlick(double{in.f0}, SchlickWeight(a)));
  }
  return errors;
}

TEST_CASE("Schlick's k is that of Karis 2013, alpha / 2 or (roughness + 1)^2 / 8") {
  CHECK(SchlickK(Shadowing::kSchlickIbl, 0.4) == Approx(0.08).epsilon(1e-15));
  CHECK(SchlickK(Shadowing::kSchlickIbl, 0.0) == 0);
  CHECK(SchlickK(Shadowing::kSchlickIbl, 1.0) == 0.5);
  CHECK(SchlickK(Shadowing::kSchlickDirect, 0.4) == Approx(0.245).epsilon(1e-15));
  // G1(l) G1(v) / (4 n.l n.v) by hand: (1/2) / (1/2 0.92 + 0.08) and (1/4) / (1/4 0.92 + 0.08).
  CHECK(VisibilitySchlick(0.5, 0.25, 0.08) ==
        Approx((0.5 / 0.54) * (0.25 / 0.31) / (4 * 0.5 * 0.25)).epsilon(1e-14));
  // With k = alpha / 2 it is near Smith's G1, within a sixth at every angle; the other is not.
  const auto error = [](Shadowing form, double cosine, double roughness) {
    const double k = SchlickK(form, roughness), alpha = AlphaFromRoughness(roughness);
    const double smith = 2 * cosine / (cosine + SmithRoot(cosine, alpha));
    return std::abs(cosine / (cosine * (1 - k) + k) / smith - 1);
  };
  double ibl = 0, direct = 0;
  for (double cosine = 1e-3; cosine <= 1; cosine *= 1.1) {
    ibl = std::max(ibl, error(Shadowing::kSchlickIbl, cosine, 0.4));
    direct = std::max(direct, error(Shadowing::kSchlickDirect, cosine, 0.4));
  }
  CHECK(ibl < 0.17);
  CHECK(direct > 0.6);
}

TEST_CASE("SIMD terms agree with their double twins on every target") {
  ForEachTarget([](Target) {
    // Highlights: v within the lobe around the mirror direction. A half vector of float inputs is
    // off by u = 6e-8 rad, which D sees as 4 u / alpha (its steepest slope); twice that for
    // the rounding of the formula.
    for (const double roughness : {0.05, 0.1, 0.3, 0.5, 1.0}) {
      CAPTURE(roughness);
      const double alpha = roughness * roughness;
      const MaxErrors errors = Measure(RandomInputs(roughness, 32, alpha));
      CHECK(errors.distribution < 8 * 0x1p-24 / alpha + 64 * 0x1p-24);
      // Cosines down to 1e-3 carry u / 1e-3; smooth terms add a few roundings.
      CHECK(errors.height_correlated < 0x1p-24 / 1e-3 * 2);
      CHECK(errors.separable < 0x1p-24 / 1e-3 * 2);
      CHECK(errors.schlick_direct < 16 * 0x1p-24);  // k >= 1/8 damps the cosines' errors
      CHECK(errors.schlick_ibl < 0x1p-24 / 1e-3 * 2);
      CHECK(errors.fresnel < 64 * 0x1p-24);
    }
    // The lobes' powers within their width, where sin(theta) < 2 / sqrt(n): n 2 sin(theta) u.
    for (const double shininess : {1.0, 32.0, 1000.0, 1e4, 1e6}) {
      CAPTURE(shininess);
      const MaxErrors errors = Measure(RandomInputs(0.5, shininess, 0.3 / std::sqrt(shininess)));
      const double bound = (16 * std::sqrt(shininess) + 64) * 0x1p-24 * 4;
      CHECK(errors.phong < 1);
      CHECK(errors.blinn < bound);
    }
  });
}

TEST_CASE("exponent 0 is 1 on every side, also where the cosine is 0 or negative") {
  const Vec3d n(0, 0, 1);
  const Vec3d l(1, 0, 0);
  CHECK(PhongLobe(n, l, Vec3d(1, 0, 0), 0.0) == 1);  // r.v = -1
  CHECK(PhongLobe(n, l, Vec3d(0, 0, 1), 0.0) == 1);  // r.v = 0
  CHECK(BlinnLobe(ComputeAngles(n, l, Vec3d(-1, 0, 0)), 0.0) == 1);
  ForEachTarget([&](Target) {
    const auto out = EvaluateTerms({{Vec3f(n), Vec3f(l), Vec3f(1, 0, 0), 0, 0.5f, 0.04f},
                                    {Vec3f(n), Vec3f(l), Vec3f(-1, 0, 0), 0, 0.5f, 0.04f}});
    CHECK(out[0].phong == 1);
    CHECK(out[1].blinn == 1);
  });
}

TEST_CASE("light exactly opposite the viewer: |l + v|^2 is a normal number, terms are finite") {
  std::vector<TermInput> inputs;
  for (const Vec3f& l : {Vec3f(1, 0, 0), Vec3f(0, 0, 1), Vec3f(0, 0.6f, 0.8f)}) {
    inputs.push_back({Vec3f(0, 0, 1), l, -l, 20, 0.5f, 0.04f});
  }
  ForEachTarget([&](Target) {
    for (const TermOutput& terms : EvaluateTerms(inputs)) {
      CHECK(std::isnormal(terms.u_squared));
      CHECK(std::isfinite(terms.blinn));
      CHECK(std::isfinite(terms.distribution));
      CHECK(terms.fresnel == 1);
    }
  });
}

TEST_CASE("Schlick is F0 at normal and 1 at grazing incidence, exactly") {
  for (const double f0 : {0.0, 0.04, 0.5, 1.0}) {
    const Vec3d n(0, 0, 1);
    CHECK(FresnelSchlick(f0, SchlickWeight(ComputeAngles(n, n, n))) == f0);
    const Angles<double> grazing = ComputeAngles(n, Vec3d(1, 0, 0), Vec3d(-1, 0, 0));
    CHECK(FresnelSchlick(f0, SchlickWeight(grazing)) == 1);
  }
}

TEST_CASE("GGX integrates to 1 over the hemisphere") {
  // int D cos dh with t = tan^2(theta): D cos dw = alpha^2 dt / (alpha^2 + t)^2 up to the azimuth;
  // in s = t / (alpha^2 + t) the integrand is constant, so the midpoint rule is exact and only
  // rounding is left (about 1e4 roundings).
  for (const double roughness : {0.02, 0.1, 0.5, 1.0}) {
    const double alpha = AlphaFromRoughness(roughness);
    constexpr int kSteps = 10000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double s = (i + 0.5) / kSteps;
      const double t = alpha * alpha * s / (1 - s);
      const double cos = 1 / std::sqrt(1 + t);
      const double sin = std::sqrt(t / (1 + t));
      const Angles<double> a =
          ComputeAngles(Vec3d(0, 0, 1), Vec3d(sin, 0, cos), Vec3d(sin, 0, cos));
      const double dt_ds = alpha * alpha / ((1 - s) * (1 - s));
      // dw cos = pi dt / (1 + t)^2
      sum += GgxDistribution(a, alpha) * M_PI * dt_ds / ((1 + t) * (1 + t)) / kSteps;
    }
    CHECK(sum == Approx(1).epsilon(1e-10));
  }
}

}  // namespace
}  // namespace nacre
