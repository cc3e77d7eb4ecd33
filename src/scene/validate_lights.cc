// SPDX-License-Identifier: Apache-2.0
// scene/validate_lights.cc: lights.
#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_set>
#include <variant>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/scene.h"
#include "scene/validate.h"
#include "scene/validate_numbers.h"

namespace nacre {
namespace {

void CheckAttenuation(const Attenuation& attenuation, const std::string& where, FaultList* faults) {
  CheckNumber(attenuation.constant, limits::kAttenuation, where + "/constant", faults);
  CheckNumber(attenuation.linear, limits::kAttenuation, where + "/linear", faults);
  CheckNumber(attenuation.quadratic, limits::kAttenuation, where + "/quadratic", faults);
  if (attenuation.constant == 0 && attenuation.linear == 0 && attenuation.quadratic == 0) {
    faults->Add(where, "all three terms are 0", "\"none\" is constant 1");
  }
}

// Of the quadratic that scales the sky's radiance, over c in [-1, 1].
double SmallestValue(const QuadraticSky& sky) {
  const auto value = [&](double c) { return (sky.quadratic * c + sky.linear) * c + sky.constant; };
  double smallest = std::min(value(-1), value(1));
  if (sky.quadratic > 0) {
    const double lowest = -sky.linear / (2 * sky.quadratic);
    if (std::abs(lowest) < 1) smallest = std::min(smallest, value(lowest));
  }
  return smallest;
}

// One overload for each kind of light and of sky.
struct LightChecker {
  const std::string& where;
  FaultList* faults;

  void operator()(const AmbientLight& light) const {
    CheckColor(light.radiance, limits::kRadiance, where + "/radiance", faults);
  }
  void operator()(const DirectionalLight& light) const {
    CheckDirection(light.direction_of_travel, where + "/direction_of_travel", faults);
    CheckColor(light.irradiance, limits::kRadiance, where + "/irradiance", faults);
  }
  void operator()(const PointLight& light) const {
    CheckPoint(light.position, where + "/position", faults);
    CheckColor(light.intensity, limits::kRadiance, where + "/intensity", faults);
    CheckAttenuation(light.attenuation, where + "/attenuation", faults);
  }
  void operator()(const SpotLight& light) const {
    CheckPoint(light.position, where + "/position", faults);
    CheckDirection(light.direction_of_travel, where + "/direction_of_travel", faults);
    CheckColor(light.intensity, limits::kRadiance, where + "/intensity", faults);
    CheckAttenuation(light.attenuation, where + "/attenuation", faults);
    CheckNumber(light.cutoff_deg, limits::kCutoffDeg, where + "/cutoff_deg", faults);
    CheckNumber(light.inner_deg, limits::kInnerDeg, where + "/inner_deg", faults);
    if (light.inner_deg > light.cutoff_deg) {
      faults->Add(where + "/inner_deg",
                  fmt::format("{} is beyond cutoff_deg, {}", light.inner_deg, light.cutoff_deg),
                  "at most cutoff_deg; equal to it for a hard edge");
    }
    CheckNumber(light.exponent, limits::kExponent, where + "/exponent", faults);
  }
  void operator()(const SphereAreaLight& light) const {
    CheckPoint(light.center, where + "/center", faults);
    CheckNumber(light.radius, limits::kLength, where + "/radius", faults);
    CheckColor(light.radiance, limits::kRadiance, where + "/radiance", faults);
  }
  void operator()(const RectangleAreaLight& light) const {
    const size_t before = faults->count();
    Flat(light);
    CheckDirection(light.up, where + "/up", faults);
    CheckNumber(light.width, limits::kLength, where + "/width", faults);
    CheckNumber(light.height, limits::kLength, where + "/height", faults);
    if (faults->count() != before) return;
    if (light.up.normalized().cross(light.facing.normalized()).length() < kMinSineOfUp) {
      faults->Add(where + "/up", "is parallel to \"facing\"", "it points along the light's height");
    }
  }
  void operator()(const DiskAreaLight& light) const {
    Flat(light);
    CheckNumber(light.radius, limits::kLength, where + "/radius", faults);
  }
  void operator()(const MeshAreaLight& light) const {
    if (light.mesh == nullptr) {
      faults->Add(where, "has no mesh", "triangles that emit");
    } else {
      ValidateTriangles(*light.mesh, where, faults);
    }
    CheckColor(light.radiance, limits::kRadiance, where + "/radiance", faults);
  }
  void operator()(const EnvironmentLight& light) const {
    std::visit(*this, light.sky);
    CheckNumber(light.rotate_deg, limits::kCoordinate, where + "/rotate_deg", faults);
  }
  void operator()(const ConstantSky& sky) const {
    CheckColor(sky.radiance, limits::kRadiance, where + "/radiance", faults);
  }
  void operator()(const GradientSky& sky) const {
    CheckColor(sky.zenith, limits::kRadiance, where + "/gradient/zenith", faults);
    CheckColor(sky.horizon, limits::kRadiance, where + "/gradient/horizon", faults);
    CheckColor(sky.ground, limits::kRadiance, where + "/gradient/ground", faults);
  }
  void operator()(const QuadraticSky& sky) const {
    const std::string place = where + "/quadratic";
    const size_t before = faults->count();
    CheckColor(sky.radiance, limits::kRadiance, place + "/radiance", faults);
    CheckDirection(sky.axis, place + "/axis", faults);
    CheckNumber(sky.constant, limits::kSkyTerm, place + "/constant", faults);
    CheckNumber(sky.linear, limits::kSkyTerm, place + "/linear", faults);
    CheckNumber(sky.quadratic, limits::kSkyTerm, place + "/quadratic", faults);
    if (faults->count() == before && SmallestValue(sky) < 0) {
      faults->Add(place, fmt::format("falls to {:g} in some direction", SmallestValue(sky)),
                  "constant + linear c + quadratic c^2 is at least 0 for c from -1 to 1");
    }
  }
  void operator()(const PictureSky& sky) const {
    CheckColor(sky.scale, limits::kRadiance, where + "/scale", faults);
    const bool whole = sky.picture != nullptr && sky.picture->width > 0 &&
                       sky.picture->height > 0 &&
                       sky.picture->rgb.size() == 3 * static_cast<size_t>(sky.picture->width) *
                                                      static_cast<size_t>(sky.picture->height);
    if (!whole) faults->Add(where + "/image", "holds no picture", "3 floats a texel");
  }

 private:
  template <class FlatLight>
  void Flat(const FlatLight& light) const {
    CheckPoint(light.center, where + "/center", faults);
    CheckDirection(light.facing, where + "/facing", faults);
    CheckColor(light.radiance, limits::kRadiance, where + "/radiance", faults);
  }
};

}  // namespace

void ValidateLights(const Scene& scene, FaultList* faults) {
  std::unordered_set<std::string> names;
  bool has_environment = false;
  for (const Light& light : scene.lights) {
    const std::string where = "/lights/" + PointerToken(light.name);
    if (!IsLayerName(light.name)) {
      faults->Add(where, "the name cannot name an image layer",
                  "1 to 64 letters, digits, spaces, '_' or '-'");
    } else if (!names.insert(light.name).second) {
      faults->Add(where, "a second light of this name", "names of lights are unique");
    }
    std::visit(LightChecker{where, faults}, light.kind);
    if (!std::holds_alternative<EnvironmentLight>(light.kind)) continue;
    if (has_environment) {
      faults->Add(where, "a second environment", "one picture holds all directions: add them up");
    }
    has_environment = true;
  }
}

}  // namespace nacre
