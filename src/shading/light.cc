// SPDX-License-Identifier: Apache-2.0
#include "shading/light.h"

#include <cmath>
#include <limits>
#include <variant>

#include "base/overloaded.h"
#include "scene/limits.h"

namespace nacre {
namespace {

AttenuationTerms<float> ToTerms(const Attenuation& a) {
  return {static_cast<float>(a.constant), static_cast<float>(a.linear),
          static_cast<float>(a.quadratic)};
}

ConeTerms<double> ToTerms(const SpotLight& spot) {
  const double first = spot.edge == SpotEdge::kSquare ? 1 : 3;
  return {OneMinusCosine(spot.cutoff_deg),
          OneMinusCosine(spot.inner_deg),
          spot.exponent,
          {first, 1 - first}};
}

// True if products with factors from 0 to 1 are in float's range, or 0.
bool IsUsual(const Rgb& color) {
  const auto usual = [](double c) { return c == 0 || (c >= 1e-30 && c <= limits::kRadiance.max); };
  return usual(color.x) && usual(color.y) && usual(color.z);
}

}  // namespace

double ShadingLight::TMax() const {
  return form == LightForm::kDirectional ? std::numeric_limits<double>::infinity() : 1.0;
}

ShadingLight PrepareLight(const Light& light, const Vec3d& camera_position) {
  ShadingLight prepared;
  std::visit(
      Overloaded{[](const auto&) {},
                 [&](const DirectionalLight& directional) {
                   prepared.form = LightForm::kDirectional;
                   prepared.color = directional.irradiance;
                   prepared.to_light = -directional.direction_of_travel.normalized();
                 },
                 [&](const PointLight& point) {
                   const Attenuation& a = point.attenuation;
                   const Rgb at_one = point.intensity / a.quadratic;
                   const bool inverse_square = a.constant == 0 && a.linear == 0 && IsUsual(at_one);
                   prepared.form = inverse_square ? LightForm::kInverseSquare : LightForm::kPoint;
                   prepared.color = inverse_square ? at_one : point.intensity;
                   prepared.position = point.position - camera_position;
                   prepared.attenuation = ToTerms(a);
                 },
                 [&](const SpotLight& spot) {
                   prepared.form = LightForm::kSpot;
                   prepared.color = spot.intensity;
                   prepared.position = spot.position - camera_position;
                   prepared.axis = spot.direction_of_travel.normalized();
                   prepared.attenuation = ToTerms(spot.attenuation);
                   prepared.cone = ToTerms(spot);
                 }},
      light.kind);
  return prepared;
}

bool OffsetFromSpheres(std::span<const Sphere> spheres, const Vec3d& camera_position,
                       ShadingLight* light) {
  light->from_spheres.clear();
  // Spot lights need exact positions: float normals are too coarse for the penumbra.
  if (light->form != LightForm::kInverseSquare && light->form != LightForm::kPoint) return false;
  for (const Sphere& sphere : spheres) {
    const Vec3d offset = light->position - (sphere.center - camera_position);
    if (!(offset.length() >= kFarRadii * sphere.radius)) {
      light->from_spheres.clear();
      return false;
    }
    light->from_spheres.push_back({Vec3f(offset), static_cast<float>(sphere.radius)});
  }
  return !light->from_spheres.empty();
}

bool EvaluatedInPlace(const ShadingLight& light) {
  return light.form == LightForm::kDirectional ||
         (light.form == LightForm::kInverseSquare && !light.from_spheres.empty());
}

}  // namespace nacre
