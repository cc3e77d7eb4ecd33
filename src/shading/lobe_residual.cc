// SPDX-License-Identifier: Apache-2.0
#include "shading/lobe_residual.h"

#include <algorithm>
#include <cmath>

#include "base/overloaded.h"
#include "brdf/ggx.h"
#include "brdf/quadrature.h"
#include "scene/limits.h"
#include "shading/golden.h"
#include "shading/measured_model.h"
#include "shading/open_pbr.h"

namespace nacre {
namespace {

constexpr int kRadialPoints = 48;
constexpr int kAzimuthPoints = 32;

// Narrower lobes are sampled as if they had this alpha, so that half vectors stay distinct in
// double.
constexpr double kLeastAlpha = 1e-6;

Vec3d Direction(double cosine, double azimuth) {
  const double sine = std::sqrt((1 - cosine) * (1 + cosine));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

// The diffuse directional albedo seen from n.v. The base depends weakly, if at all, on the azimuth
// between light and viewer, so a single one is used, a quarter turn.
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

// Sums over the samples of one view, for both materials.
struct ViewSums {
  double difference2 = 0, original2 = 0;
  Rgb albedo{0, 0, 0};  // the directional albedo of the other's lobe, minus the original's
};

// What is compared of a material: its lobe, or all that it reflects, if the original's values do
// not tell lobe and base apart.
Rgb ComparedOf(const Reflection& reflection, bool whole) {
  return whole ? reflection.Sum() : reflection.specular;
}

ViewSums SumView(const ShadingMaterial& original, const ShadingMaterial& other, double alpha,
                 double view_deg, bool whole) {
  const Vec3d to_view = ViewDirection(view_deg);
  ViewSums sums;
  for (const LobeSample& sample : MakeLobeSamples(alpha, view_deg)) {
    const Rgb a = ComparedOf(Reflect(original, Vec3d(0, 0, 1), sample.to_light, to_view), whole);
    const Rgb b = ComparedOf(Reflect(other, Vec3d(0, 0, 1), sample.to_light, to_view), whole);
    const Rgb difference = b - a;
    sums.difference2 += (difference ^ difference) * sample.weight;
    sums.original2 += (a ^ a) * sample.weight;
    sums.albedo += difference * sample.weight;
  }
  return sums;
}

// A highlight in the plane of incidence, all channels together.
struct Highlight {
  double peak = 0;   // the largest BRDF n.l
  double width = 0;  // full width at half maximum, as an angle of light, up to the horizon
};

Highlight MeasureHighlight(const ShadingMaterial& material, double view_deg, bool whole) {
  const double mirror = view_deg * M_PI / 180;
  const auto lobe = [&](double light) {
    const Vec3d to_light(-std::sin(light), 0, std::cos(light));
    const Rgb rgb =
        ComparedOf(Reflect(material, Vec3d(0, 0, 1), to_light, ViewDirection(view_deg)), whole);
    return rgb.x + rgb.y + rgb.z;
  };
  // Angles of light from horizon to horizon. Their distance from the mirror direction grows by a
  // tenth per step, starting at a tenth of the narrowest lobe's width, so that lobes of every width
  // are found.
  std::vector<double> lights = {-M_PI / 2, mirror, M_PI / 2};
  for (double distance = kLeastAlpha / 10; distance < M_PI; distance *= 1.1) {
    if (mirror - distance > -M_PI / 2) lights.push_back(mirror - distance);
    if (mirror + distance < M_PI / 2) lights.push_back(mirror + distance);
  }
  std::sort(lights.begin(), lights.end());
  const size_t last = lights.size() - 1;
  size_t top = 0;
  for (size_t i = 1; i <= last; ++i) {
    if (lobe(lights[i]) > lobe(lights[top])) top = i;
  }
  const double at_peak =
      GoldenMinimum([&](double light) { return -lobe(light); }, lights[top == 0 ? 0 : top - 1],
                    lights[std::min(top + 1, last)]);
  const double half = lobe(at_peak) / 2;
  if (!(half > 0)) return {};
  size_t low = top;
  while (low > 0 && lobe(lights[low]) >= half) --low;
  size_t high = top;
  while (high < last && lobe(lights[high]) >= half) ++high;
  // The lobe crosses half its maximum between `outside` and `inside`.
  const auto at_half = [&](double outside, double inside) {
    if (lobe(outside) >= half) return outside;
    for (int i = 0; i < 60; ++i) {
      const double middle = (outside + inside) / 2;
      (lobe(middle) >= half ? inside : outside) = middle;
    }
    return inside;
  };
  return {2 * half, at_half(lights[high], at_peak) - at_half(lights[low], at_peak)};
}

double RelativeRms(double difference2, double original2) {
  if (difference2 == 0) return 0;
  return std::sqrt(difference2 / original2);  // infinite where the original has no lobe
}

}  // namespace

Vec3d ViewDirection(double view_deg) { return Direction(std::cos(view_deg * M_PI / 180), 0); }

std::array<HighlightView, 4> HighlightViews() {
  const QuadratureRule& rule = GaussLegendre(4);
  std::array<HighlightView, 4> views;
  for (size_t i = 0; i < views.size(); ++i) {
    views[i] = {std::acos(rule.x[i]) / 2 * 180 / M_PI, rule.w[i]};
  }
  return views;
}

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
  // The result is finite for a mirror, too, as exponents of scenes must be.
  const double blinn = std::max(2 / (alpha * alpha) - 2, 0.0);
  return std::min(model == PhongModel::kBlinnPhong ? blinn : blinn / 4, limits::kExponent.max);
}

double LobeAlpha(const Material& material) {
  return std::visit(
      Overloaded{
          [](const PhongMaterial& m) { return AlphaFromExponent(m.model, m.shininess); },
          [](const MetallicRoughnessMaterial& m) { return AlphaFromRoughness(m.roughness); },
          [](const ConductorMaterial& m) { return AlphaFromRoughness(m.roughness); },
          [](const DielectricMaterial& m) { return AlphaFromRoughness(m.roughness); },
          [](const OpenPbrMaterial& m) { return AlphaFromRoughness(RoughnessBelowCoat(m)); },
          [](const MeasuredMaterial& m) {
            // Where GGX has fallen to 1/e, tan(theta) is sqrt(sqrt(e) - 1) alpha.
            constexpr double kWidthOverAlpha = 0.8054;
            if (!m.brdf) return 1.0;
            return std::min(MeasuredLobeWidth({m.brdf, m.interpolation}) / kWidthOverAlpha, 1.0);
          },
          [](const auto&) { return 1.0; }},
      material.model);
}

MaterialResidual MeasureResidual(const Material& original, const Material& other) {
  const ShadingMaterial a = PrepareMaterial(original);
  const ShadingMaterial b = PrepareMaterial(other);
  const double alpha = 1.5 * LobeAlpha(original);  // wider, for the flanks
  const bool whole = std::holds_alternative<MeasuredMaterial>(original.model);
  MaterialResidual residual;
  for (const double view_deg : kResidualViewsDeg) {
    const ViewSums sums = SumView(a, b, alpha, view_deg, whole);
    const Highlight from = MeasureHighlight(a, view_deg, whole);
    const Highlight to = MeasureHighlight(b, view_deg, whole);
    const double n_dot_v = ViewDirection(view_deg).z;
    Rgb albedo = sums.albedo;
    if (!whole) albedo += DiffuseAlbedoAt(b, n_dot_v) - DiffuseAlbedoAt(a, n_dot_v);
    residual.views.push_back(
        {.view_deg = view_deg,
         .rms = RelativeRms(sums.difference2, sums.original2),
         .peak = from.peak > 0 ? to.peak / from.peak - 1 : 0,
         .width = from.width > 0 && to.width > 0 ? to.width / from.width - 1 : 0,
         .albedo = std::max({std::abs(albedo.x), std::abs(albedo.y), std::abs(albedo.z)})});
  }
  double difference2 = 0;
  double original2 = 0;
  for (const auto& [view_deg, weight] : HighlightViews()) {
    const ViewSums sums = SumView(a, b, alpha, view_deg, whole);
    difference2 += weight * sums.difference2;
    original2 += weight * sums.original2;
  }
  residual.rms = RelativeRms(difference2, original2);
  return residual;
}

Rgb DiffuseAlbedo(const Material& material) {
  const ShadingMaterial prepared = PrepareMaterial(material);
  const QuadratureRule& rule = GaussLegendre(12);
  Rgb sum(0);
  for (size_t i = 0; i < rule.x.size(); ++i) {
    sum += DiffuseAlbedoAt(prepared, rule.x[i]) * (2 * rule.w[i] * rule.x[i]);
  }
  return sum;
}

}  // namespace nacre
