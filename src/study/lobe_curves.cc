// SPDX-License-Identifier: Apache-2.0
#include "study/lobe_curves.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "color/luminance.h"
#include "shading/lobe_residual.h"
#include "study/reflection.h"

namespace nacre {
namespace {

constexpr int kLobePoints = 481;
constexpr double kLastDegree = 89.9;  // degrees: at 90 there is no light

// The range of angles around the mirror direction in degrees. The light turns twice as fast as the
// half vector, and at eight times alpha, GGX has fallen to 1/4000 of its peak.
double HalfRange(const Material& first) {
  return std::max(2 * 8 * LobeAlpha(first) * 180 / M_PI, 0.1);
}

Curve LobeCurve(const NamedLobe& lobe, double view_deg, double from, double to) {
  const ShadingMaterial material = PrepareMaterial(lobe.material);
  Curve curve;
  curve.title = lobe.label;
  curve.x.reserve(kLobePoints);
  curve.y.reserve(kLobePoints);
  for (int i = 0; i < kLobePoints; ++i) {
    const double degrees = from + (to - from) * i / (kLobePoints - 1);
    const Reflection reflection =
        Reflect(material, Vec3d(0, 0, 1), DirectionAt(degrees), DirectionAt(-view_deg));
    curve.x.push_back(degrees);
    curve.y.push_back(Luminance(reflection.specular));
  }
  return curve;
}

}  // namespace

Figure LobeFigure(const std::vector<NamedLobe>& lobes) {
  const double reach = HalfRange(lobes.front().material);
  Figure figure;
  figure.columns = 2;
  figure.width = 1700;
  figure.height = 1300;
  for (const double view_deg : kResidualViewsDeg) {
    const double from = std::max(view_deg - reach, -kLastDegree);
    const double to = std::min(view_deg + reach, kLastDegree);
    Plot plot;
    plot.title = fmt::format("viewer at {:g}°", view_deg);
    plot.x = {.label = "angle of the light (degrees)",
              .low = from == -kLastDegree ? -90 : from,
              .high = to == kLastDegree ? 90 : to};
    plot.y = {.label = "specular radiance per irradiance (1/sr)", .low = 0};
    double largest = 0;
    for (const NamedLobe& lobe : lobes) {
      plot.curves.push_back(LobeCurve(lobe, view_deg, from, to));
      const std::vector<double>& y = plot.curves.back().y;
      largest = std::max(largest, *std::max_element(y.begin(), y.end()));
    }
    if (largest > 0) plot.y.high = 1.5 * largest;  // leaves room for the legend above the lobes
    plot.rules.push_back({Rule::Across::kX, view_deg, "mirror"});
    figure.panels.push_back(std::move(plot));
  }
  return figure;
}

}  // namespace nacre
