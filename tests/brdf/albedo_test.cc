// SPDX-License-Identifier: Apache-2.0
// tests/brdf/albedo_test.cc: the run-time albedos against the quadratures that they were fitted to,
// on every target, and white furnaces: a lobe and its compensation together reflect all light.
#include "brdf/albedo.h"

#include <algorithm>
#include <cmath>

#include "brdf/albedo_integral.h"
#include "brdf/albedo_table.h"
#include "brdf/energy_kernel.h"
#include "brdf/multi_scatter.h"
#include "brdf/quadrature.h"
#include "catch.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr Shadowing kForms[] = {Shadowing::kHeightCorrelated, Shadowing::kSeparable,
                                Shadowing::kSchlickDirect, Shadowing::kSchlickIbl};
constexpr double kEta = 1.5;

double Dielectric(double v_dot_h, double one_minus_vh) {
  return FresnelDielectric(v_dot_h, one_minus_vh, kEta);
}

std::vector<float> FurnaceCosines() {
  return {1e-4f, 1e-3f, 0.01f, 0.05f, 0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.7f, 0.8f, 0.9f, 1.0f};
}

std::vector<double> FurnaceRoughnesses() {
  return {0, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1};
}

// Bounds: the tables are made to 3e-4 by a rule of three times that error where there is one
// corner. Its convergence is slow where a lobe's weight makes two of them, and where a coat thinner
// than air reflects all light itself, which takes it from the base at once.
TEST_CASE("albedos follow the corner of total reflection from a denser medium") {
  struct Base {
    const char* what;
    CoatedDielectric<double> base;
    double critical_sine, bound;
  };
  constexpr double kOne = 1e-3, kTwo = 3e-3;
  const Base bases[] = {
      {"bare 0.3", {.eta = 0.3}, 0.3, kOne},
      {"bare 0.67", {.eta = 0.67}, 0.67, kOne},
      {"bare 0.9", {.eta = 0.9}, 0.9, kOne},
      {"bare 0.99", {.eta = 0.99}, 0.99, kOne},
      {"half coated", {0.67, 0.5, 0.67 / 1.5, 1 / 1.5}, 0.67, kOne},
      {"coated", {0.67, 1, 0.67 / 1.5, 1 / 1.5}, 0.67, kOne},
      {"weighted below a coat", {1.1, 1, 0.6, 1 / 1.5}, 0.9, kOne},
      {"weighted below half a coat", {0.8, 0.5, 0.6, 1 / 1.5}, 0.9, kTwo},
      {"below a thin coat", {1.5, 1, 1.5 / 0.7, 1 / 0.7}, 0.7, kTwo},
      {"below half a thin coat", {1.5, 0.5, 1.5 / 0.7, 1 / 0.7}, 0.7, kTwo},
  };
  double worst = 0;
  for (const auto& [what, base, critical_sine, bound] : bases) {
    for (const double roughness : {0.01, 0.1, 0.3, 0.6, 1.0}) {
      const FresnelAlbedoFit fit =
          MakeDielectricAlbedoFit(Shadowing::kHeightCorrelated, roughness, base);
      REQUIRE(fit.corner != nullptr);
      const double critical = std::sqrt(1 - critical_sine * critical_sine);
      for (const double place : {0.01, 0.1, 0.5 * critical, critical - 0.02, critical,
                                 critical + 0.02, (1 + critical) / 2, 1.0}) {
        const double mu = std::clamp(place, 0.01, 1.0);
        const double exact = AlbedoOf(Shadowing::kHeightCorrelated, roughness, mu,
                                      [&base = base](double v_dot_h, double one_minus_vh) {
                                        return FresnelCoatedDielectric(v_dot_h, one_minus_vh, base);
                                      },
                                      {24, 0.03, 1e-8, critical});  // finer than the table's rule
        CAPTURE(what, roughness, mu);
        const double error = std::abs(AlbedoFresnel(fit, mu) - exact);
        CHECK(error <= bound);
        worst = std::max(worst, error);
      }
    }
  }
  WARN("largest error " << worst);
}

TEST_CASE("albedo fits are within their tolerances at and between the table's roughnesses") {
  std::vector<float> cosines;
  for (int i = 0; i < 16; ++i) cosines.push_back(static_cast<float>(std::pow(10, -4 + i / 4.0)));
  for (const float mu : {0.25f, 0.4f, 0.7f, 0.9f, 1.0f}) cosines.push_back(mu);
  std::vector<double> roughnesses = {0, 1e-4, 1e-3, 0.01, 0.02, 0.05};
  // The table's own stand at (i / 40)^2; every other one here is midway between two of them.
  for (int i = 2; i < 40; i += 2) {
    roughnesses.push_back(std::pow((i + (i % 4 == 0 ? 0 : 0.5)) / 40, 2));
  }
  roughnesses.push_back(0.982);  // where the interpolation is worst
  roughnesses.push_back(1);
  for (const Shadowing form : kForms) {
    for (const double roughness : roughnesses) {
      CAPTURE(static_cast<int>(form), roughness);
      const AlbedoFit fit = MakeAlbedoFit(form, roughness);
      double one = 0;
      double one_relative = 0;
      double schlick = 0;
      double mixed = 0;
      for (const float mu : cosines) {
        const double e = AlbedoOfOne(form, roughness, mu);
        const double b = AlbedoOfSchlick(form, roughness, mu);
        const double e_error = AlbedoOne(fit, mu) - e;
        const double b_error = AlbedoSchlick(fit, mu) - b;
        one = std::max(one, std::abs(e_error));
        one_relative = std::max(one_relative, std::abs(e_error) / e);
        schlick = std::max(schlick, std::abs(b_error));
        mixed = std::max(mixed, std::abs(0.04 * e_error + 0.96 * b_error));
      }
      CHECK(one < 5e-5);
      CHECK(one_relative < 5e-4);  // compensation divides by E
      CHECK(schlick < 5e-5);
      CHECK(mixed < 5e-5);  // white dielectrics are to furnace within [.999, 1.0001]
    }
  }
}

TEST_CASE("average albedos are right, and those of the fits") {
  for (const Shadowing form : kForms) {
    for (const double roughness : {0.0, 0.003, 0.03, 0.2, 0.55, 1.0}) {
      CAPTURE(static_cast<int>(form), roughness);
      const AlbedoFit fit = MakeAlbedoFit(form, roughness);
      const double e_average = IntegrateTowardsZero(
          [&](double mu) { return 2 * mu * AlbedoOfOne(form, roughness, mu); });
      CHECK(std::abs(fit.e_average - e_average) < 1e-4);
      const double loss =
          IntegrateTowardsZero([&](double mu) { return 2 * mu * AlbedoLoss(fit, mu); });
      // Relative: Kulla and Conty's lobe divides by it. Held to a fifth of the furnace's 1e-3.
      CHECK(std::abs(loss - (1 - fit.e_average)) <= 2e-4 * loss);
      const double schlick = IntegrateTowardsZero(
          [&](double mu) { return 2 * mu * AlbedoOfSchlick(form, roughness, mu); }, 16);
      CHECK(std::abs(fit.schlick_average - schlick) < 5e-5);
    }
  }
}

TEST_CASE("dielectric albedo fits are within 5e-5 of the truth") {
  for (const Shadowing form : kForms) {
    for (const double roughness : {0.0, 0.004, 0.01, 0.02, 0.04, 0.07, 0.1, 0.15, 0.3, 0.6, 1.0}) {
      CAPTURE(static_cast<int>(form), roughness);
      const FresnelAlbedoFit fit = MakeDielectricAlbedoFit(form, roughness, {kEta});
      double worst = 0;
      for (const float mu : FurnaceCosines()) {
        worst = std::max(
            worst, std::abs(AlbedoFresnel(fit, mu) - AlbedoOf(form, roughness, mu, Dielectric)));
      }
      CHECK(worst < 5e-5);
      if (roughness < 0.1) continue;  // the truth's average is slow for narrow lobes
      const double average = IntegrateTowardsZero(
          [&](double mu) { return 2 * mu * AlbedoOf(form, roughness, mu, Dielectric); }, 12);
      CHECK(std::abs(fit.average - average) < 5e-5);
    }
  }
}

TEST_CASE("SIMD albedos are their scalar twins on every target, in range everywhere") {
  std::vector<float> cosines = {-1.0f, -0.0f, 0.0f, 1e-40f, 1e-30f, 1e-12f, 1e-7f, 1 + 0x1p-23f};
  for (int i = 0; i <= 500; ++i) cosines.push_back(static_cast<float>(std::pow(10, -i / 100.0)));
  for (const Shadowing form : kForms) {
    for (const double roughness : {0.0, 1e-6, 1e-3, 0.01, 0.1, 0.37, 1.0}) {
      CAPTURE(static_cast<int>(form), roughness);
      const FresnelAlbedoFit fit = MakeDielectricAlbedoFit(form, roughness, {kEta});
      ForEachTarget([&](Target) {
        const std::vector<AlbedoOutput> outputs = EvaluateAlbedos(fit, cosines);
        // The polynomials' coefficients sum to less than 50, so the error is at most 50 roundings
        // of 1.
        constexpr double kRounding = 50 * 0x1p-24;
        double worst = 0;
        bool in_range = true;
        for (size_t i = 0; i < cosines.size(); ++i) {
          const double mu = cosines[i];
          const AlbedoOutput& out = outputs[i];
          for (const double error :
               {out.one - AlbedoOne(fit.lobe, mu), out.loss - AlbedoLoss(fit.lobe, mu),
                out.schlick - AlbedoSchlick(fit.lobe, mu), out.fresnel - AlbedoFresnel(fit, mu)}) {
            worst = std::max(worst, std::abs(error));
          }
          for (const float value : {out.one, out.loss, out.schlick, out.fresnel}) {
            in_range = in_range && value >= 0 && value <= 1;
          }
          in_range = in_range && out.one > 0;
        }
        CHECK(worst < kRounding);
        CHECK(in_range);
      });
    }
  }
}

// Conductors must reflect 1 +- 1e-3, white dielectrics between .999 and 1.0001.
TEST_CASE("white furnace: conductors, either compensation") {
  for (const Shadowing form : kForms) {
    for (const double roughness : FurnaceRoughnesses()) {
      const AlbedoFit fit = MakeAlbedoFit(form, roughness);
      const double loss = IntegrateTowardsZero(
          [&](double mu) { return 2 * mu * AlbedoLoss(fit, static_cast<float>(mu)); });
      for (const float mu : FurnaceCosines()) {
        CAPTURE(static_cast<int>(form), roughness, mu);
        const double e = AlbedoOfOne(form, roughness, mu);
        CHECK(std::abs(e / AlbedoOne(fit, mu) - 1) <= 1e-3);  // Turquin's factor of F0 = 1
        const double second_lobe =
            AlbedoLoss(fit, mu) * M_PI * KullaContyScale(fit.e_average) * loss;
        CHECK(std::abs(e + second_lobe - 1) <= 1e-3);
      }
    }
  }
}

TEST_CASE("white furnace: dielectrics over a white diffuse base") {
  const float f0 = 0.04f;
  for (const Shadowing form : kForms) {
    for (const double roughness : FurnaceRoughnesses()) {
      const FresnelAlbedoFit fit = MakeDielectricAlbedoFit(form, roughness, {kEta});
      for (const float mu : FurnaceCosines()) {
        CAPTURE(static_cast<int>(form), roughness, mu);
        const float e = AlbedoOne(fit.lobe, mu);
        const float factor = 1 + f0 * (1 / e - 1);  // Turquin 2019, eq. 16
        // The base gets what the lobe's own albedo, as fitted, leaves.
        const double schlick_truth =
            f0 * AlbedoOfOne(form, roughness, mu) + (1 - f0) * AlbedoOfSchlick(form, roughness, mu);
        const double schlick_fit =
            FresnelSchlick(f0 * e, 0.0f) + (1 - f0) * AlbedoSchlick(fit.lobe, mu);
        const double exact_truth = AlbedoOf(form, roughness, mu, Dielectric);
        const double exact_fit = AlbedoFresnel(fit, mu);
        for (const double furnace : {factor * schlick_truth + (1 - factor * schlick_fit),
                                     factor * exact_truth + (1 - factor * exact_fit)}) {
          CHECK(furnace >= 0.999);
          CHECK(furnace <= 1.0001);
        }
      }
    }
  }
}

TEST_CASE("curves of an index blended by roughness are near those of the roughness") {
  double worst = 0, worst_average = 0;
  for (const Shadowing form :
       {Shadowing::kHeightCorrelated, Shadowing::kSeparable, Shadowing::kSchlickDirect}) {
    for (const double eta : {1.1, 1.5, 2.4}) {
      const DielectricCurves curves = MakeDielectricCurves(form, {eta});
      for (const double roughness : {0.004, 0.02, 0.09, 0.3, 0.47, 0.81, 1.0}) {
        const FresnelAlbedoFit fit = MakeDielectricAlbedoFit(form, roughness, {eta});
        FresnelAlbedoFit blend = fit;
        const AlbedoWeights at = FindAlbedoWeights(roughness);
        blend.fresnel = {};
        double average = 0;
        for (size_t i = 0; i < 4; ++i) {
          const size_t node = static_cast<size_t>(at.first) + i;
          for (size_t k = 0; k < kAlbedoTerms; ++k) {
            blend.fresnel[k] += static_cast<float>(at.weights[i]) * curves.fresnel[node][k];
          }
          average += at.weights[i] * curves.average[node];
        }
        for (const double mu : {1e-4, 1e-3, 0.01, 0.1, 0.3, 0.6, 1.0}) {
          worst = std::max(worst, std::abs(AlbedoFresnel(fit, mu) - AlbedoFresnel(blend, mu)));
        }
        worst_average = std::max(worst_average, std::abs(average - fit.average));
      }
    }
  }
  CAPTURE(worst, worst_average);
  CHECK(worst <= 3e-5);
  CHECK(worst_average <= 3e-5);
}

}  // namespace
}  // namespace nacre
