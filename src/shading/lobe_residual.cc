// SPDX-License-Identifier: Apache-2.0
#include "shading/lobe_residual.h"

#include <algorithm>
#include <cmath>

#include "base/overloaded.h"
#include "brdf/ggx.h"
#include "brdf/quadrature.h"
#include "scene/limits.h"

namespace nacre {
namespace {

constexpr int kRadialPoints = 48;
constexpr int kAzimuthPoints = 32;

// Narrower lobes are sampled as if they had this alpha: half vectors stay apart in double.
constexpr double kLeastAlpha = 1e-6;

Vec3d Direction(double cosine, double azimuth) {
  const double sine = std::sqrt((1 - cosine) * (1 + cosine));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

// The part of the light that comes from everywhere and is reflected towards the viewer diffusely.
// The base depends on azimuths, if at all, weakly: they are a quarter turn apart.
Rgb DiffuseAlbedoAt(const ShadingMaterial& material, double n_dot_v) {
  const QuadratureRule& rule = GaussLegendre(12);
  Rgb sum(0);
  for (size_t i = 0; i < rule.x.size(); ++i) {
    const Reflection response =
        Reflect(material, Vec3d(0, 0, 1), Direction(rule.x[i], M_PI / 2), Direction(n_dot_v, 0));
    sum += response.diffuse * (rule.w[i] * 2 * M_PI);
  }
  return sum;
}

// Of both materials at one view; squares and albedos still to be divided.
struct ViewSums {
  double difference2 = 0, original2 = 0;
  double original_peak = 0, other_peak = 0;
  Rgb albedo{0, 0, 0};  // of the other, minus the original's
};

ViewSums SumView(const ShadingMaterial& original, const ShadingMaterial& other, double alpha,
                 double view_deg) {
  const Vec3d to_view = ViewDirection(view_deg);
  ViewSums sums;
  for (const LobeSample& sample : MakeLobeSamples(alpha, view_deg)) {
    const Rgb a = Reflect(original, Vec3d(0, 0, 1), sample.to_light, to_view).specular;
    const Rgb b = Reflect(other, Vec3d(0, 0, 1), sample.to_light, to_view).specular;
    const Rgb difference = b - a;
    sums.difference2 += (difference ^ difference) * sample.weight;
    sums.original2 += (a ^ a) * sample.weight;
    sums.original_peak = std::max(sums.original_peak, a.x + a.y + a.z);
    sums.other_peak = std::max(sums.other_peak, b.x + b.y + b.z);
    sums.albedo += difference * sample.weight;
  }
  sums.albedo += DiffuseAlbedoAt(other, to_view.z) - DiffuseAlbedoAt(original, to_view.z);
  return sums;
}

double RelativeRms(double difference2, double original2) {
  if (difference2 == 0) return 0;
  return std::sqrt(difference2 / original2);  // infinite where there was no lobe
}

}  // namespace

Vec3d ViewDirection(double view_deg) { return Direction(std::cos(view_deg * M_PI / 180), 0); }

double ViewWeight(double view_deg) { return std::cos(view_deg * M_PI / 180); }

std::vector<LobeSample> MakeLobeSamples(double alpha, double view_deg) {
  const double a = std::clamp(alpha, kLeastAlpha, 1.0);
  const Vec3d to_view = ViewDirection(view_deg);
  std::vector<LobeSample> samples;
  samples.reserve(static_cast<size_t>(kRadialPoints) * kAzimuthPoints);
  for (int i = 0; i < kRadialPoints; ++i) {
    // Walter et al. 2007, eq. 35, at the middle of each stratum.
    const double u = (i + 0.5) / kRadialPoints;
    const double tan2 = a * a * u / (1 - u);
    const double cos2 = 1 / (1 + tan2);
    const double sine = std::sqrt(tan2 * cos2);
    const double cosine = std::sqrt(cos2);
    const double root = cos2 * (a * a + tan2);
    const double pdf_half = a * a * cosine / (M_PI * root * root);
    for (int j = 0; j < kAzimuthPoints; ++j) {
      const double azimuth = M_PI * (j + 0.5) / kAzimuthPoints;
      const Vec3d half(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine);
      const double v_dot_h = to_view ^ half;
      if (!(v_dot_h > 0)) continue;
      const Vec3d to_light = (half * (2 * v_dot_h) - to_view).normalized();
      if (!(to_light.z > 0)) continue;
      samples.push_back({to_light, 4 * v_dot_h / (pdf_half * kRadialPoints * kAzimuthPoints)});
    }
  }
  return samples;
}

double AlphaFromExponent(PhongModel model, double shininess) {
  const double blinn = model == PhongModel::kBlinnPhong ? shininess : 4 * shininess;
  return std::sqrt(2 / (blinn + 2));
}

double ExponentFromAlpha(PhongModel model, double alpha) {
  // Finite for a mirror, as exponents of scenes are.
  const double blinn = std::max(2 / (alpha * alpha) - 2, 0.0);
  return std::min(model == PhongModel::kBlinnPhong ? blinn : blinn / 4, limits::kExponent.max);
}

double LobeAlpha(const Material& material) {
  return std::visit(
      Overloaded{[](const PhongMaterial& m) { return AlphaFromExponent(m.model, m.shininess); },
                 [](const MetallicRoughnessMaterial& m) { return AlphaFromRoughness(m.roughness); },
                 [](const ConductorMaterial& m) { return AlphaFromRoughness(m.roughness); },
                 [](const DielectricMaterial& m) { return AlphaFromRoughness(m.roughness); },
                 [](const auto&) { return 1.0; }},
      material.model);
}

MaterialResidual MeasureResidual(const Material& original, const Material& other) {
  const ShadingMaterial a = PrepareMaterial(original, Rgb(0));
  const ShadingMaterial b = PrepareMaterial(other, Rgb(0));
  const double alpha = 1.5 * LobeAlpha(original);  // wider, for the flanks
  MaterialResidual residual;
  double weighted = 0;
  double weights = 0;
  for (const double view_deg : kResidualViewsDeg) {
    const ViewSums sums = SumView(a, b, alpha, view_deg);
    const double rms = RelativeRms(sums.difference2, sums.original2);
    weighted += ViewWeight(view_deg) * rms * rms;
    weights += ViewWeight(view_deg);
    const Rgb& albedo = sums.albedo;
    residual.views.push_back(
        {.view_deg = view_deg,
         .rms = rms,
         .peak = sums.original_peak > 0 ? sums.other_peak / sums.original_peak - 1 : 0,
         .albedo = std::max({std::abs(albedo.x), std::abs(albedo.y), std::abs(albedo.z)})});
  }
  residual.rms = std::sqrt(weighted / weights);
  return residual;
}

Rgb DiffuseAlbedo(const Material& material) {
  const ShadingMaterial prepared = PrepareMaterial(material, Rgb(0));
  const QuadratureRule& rule = GaussLegendre(12);
  Rgb sum(0);
  for (size_t i = 0; i < rule.x.size(); ++i) {
    sum += DiffuseAlbedoAt(prepared, rule.x[i]) * (2 * rule.w[i] * rule.x[i]);
  }
  return sum;
}

}  // namespace nacre
