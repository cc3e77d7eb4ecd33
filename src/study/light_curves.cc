// SPDX-License-Identifier: Apache-2.0
#include "study/light_curves.h"

#include <cmath>

#include <fmt/format.h>

#include "base/overloaded.h"
#include "color/display.h"
#include "color/luminance.h"
#include "color/transfer.h"
#include "light/disk_light.h"
#include "light/polygon_irradiance.h"
#include "light/punctual.h"
#include "light/sphere_light.h"

namespace nacre {
namespace {

double FalloffOf(const Attenuation& a, double distance) {
  return AttenuationFactor(AttenuationTerms<double>{a.constant, a.linear, a.quadratic}, distance);
}

// The light's centre is at distance times kUp from the shaded point, and the light faces down.
const Vec3d kUp(0, 0, 1);

}  // namespace

std::optional<double> IrradianceAt(const Light& light, double distance) {
  using Result = std::optional<double>;
  return std::visit(
      Overloaded{[&](const DirectionalLight& sun) -> Result { return Luminance(sun.irradiance); },
                 [&](const PointLight& point) -> Result {
                   return Luminance(point.intensity) * FalloffOf(point.attenuation, distance);
                 },
                 // On the axis, the cone's factor is 1.
                 [&](const SpotLight& spot) -> Result {
                   return Luminance(spot.intensity) * FalloffOf(spot.attenuation, distance);
                 },
                 [&](const SphereAreaLight& sphere) -> Result {
                   if (distance <= sphere.radius) return std::nullopt;
                   return Luminance(sphere.radiance) *
                          Irradiance(SphereLight<double>{kUp * distance, sphere.radius}, kUp);
                 },
                 [&](const RectangleAreaLight& area) -> Result {
                   const RectangleLight<double> rectangle{
                       Vec3d(-area.width / 2, -area.height / 2, distance), Vec3d(area.width, 0, 0),
                       Vec3d(0, area.height, 0)};
                   return Luminance(area.radiance) * Irradiance(rectangle, kUp);
                 },
                 [&](const DiskAreaLight& disk) -> Result {
                   return Luminance(disk.radiance) *
                          Irradiance(DiskLight<double>{kUp * distance, -kUp, disk.radius}, kUp);
                 },
                 // Lights all around, and triangle meshes, which have no axis to measure along.
                 [](const auto&) -> Result { return std::nullopt; }},
      light.kind);
}

bool HasFalloff(const Light& light) {
  return !std::holds_alternative<AmbientLight>(light.kind) &&
         !std::holds_alternative<MeshAreaLight>(light.kind) &&
         !std::holds_alternative<EnvironmentLight>(light.kind);
}

Plot FalloffPlot(const std::vector<Light>& lights) {
  constexpr double kNearest = 0.1;
  constexpr int kDecades = 3;
  std::vector<double> distances = Steps(0, kDecades, 60 * kDecades);
  for (double& distance : distances) distance = kNearest * std::pow(10, distance);
  Plot plot;
  plot.x = {.label = "distance from the light's centre (world units)", .log = true};
  plot.y = {.label = "irradiance facing the light (radiance · sr)", .log = true};
  for (const Light& light : lights) {
    plot.curves.push_back(MakeCurve(light.name, distances, [&](double distance) {
      return IrradianceAt(light, distance).value_or(kFromData);
    }));
  }
  return plot;
}

Plot TonePlot(double exposure_ev) {
  Plot plot;
  plot.x = {.label = "scene radiance of a grey (1: white before the operator)",
            .log = true,
            .low = 1e-3,
            .high = 100};
  plot.y = {.label = "display value, sRGB encoded (1: white)", .low = 0, .high = 1};
  std::vector<double> radiances = Steps(-3, 2, 500);
  for (double& radiance : radiances) radiance = std::pow(10, radiance);
  for (const std::string& name : ToneOperatorNames()) {
    const DisplaySettings settings{.tone = ParseToneOperator(name), .exposure_ev = exposure_ev};
    const std::string title =
        name == "reinhard_extended" ? fmt::format("{}, white at {:g}", name, settings.white) : name;
    plot.curves.push_back(MakeCurve(title, radiances, [&](double radiance) {
      return SrgbOetf(DisplayLight(settings, Imath::Color3<double>(radiance)).y);
    }));
  }
  plot.rules.push_back({Rule::Across::kX, 0.18, "middle grey"});
  return plot;
}

}  // namespace nacre
