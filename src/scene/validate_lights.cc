// SPDX-License-Identifier: Apache-2.0
// scene/validate_lights.cc: the part of Validate() that checks lights.
#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_set>
#include <variant>

#include <fmt/format.h>

#include "scene/scene.h"
#include "scene/validate.h"
#include "scene/validate_numbers.h"

namespace nacre {
namespace {

// The smallest value of the quadratic that scales the sky's radiance, over c in [-1, 1].
double SmallestValue(const QuadraticSky& sky) {
  const auto value = [&](double c) { return (sky.quadratic * c + sky.linear) * c + sky.constant; };
  double smallest = std::min(value(-1), value(1));
  if (sky.quadratic > 0) {
    const double lowest = -sky.linear / (2 * sky.quadratic);
    if (std::abs(lowest) < 1) smallest = std::min(smallest, value(lowest));
  }
  return smallest;
}

// Checks the keys of each kind of light and sky, and the conditions that link them.
struct LightChecker {
  const std::string& where;
  FaultList* faults;

  template <class Kind>
  void operator()(const Kind& kind) const {
    CheckKeys(kind, where, faults);
    if constexpr (requires { kind.attenuation; }) {
      const Attenuation& attenuation = kind.attenuation;
      if (attenuation.constant == 0 && attenuation.linear == 0 && attenuation.quadratic == 0) {
        faults->Add(where + "/attenuation", "all three terms are 0", "\"none\" is constant 1");
      }
    }
  }
  void operator()(const SpotLight& light) const {
    operator()<SpotLight>(light);
    if (light.inner_deg > light.cutoff_deg) {
      faults->Add(where + "/inner_deg",
                  fmt::format("{} is beyond cutoff_deg, {}", light.inner_deg, light.cutoff_deg),
                  "at most cutoff_deg; equal to it for a hard edge");
    }
  }
  void operator()(const RectangleAreaLight& light) const {
    const size_t before = faults->count();
    operator()<RectangleAreaLight>(light);
    if (faults->count() != before) return;
    if (light.up.normalized().cross(light.facing.normalized()).length() < kMinSineOfUp) {
      faults->Add(where + "/up", "is parallel to \"facing\"", "it points along the light's height");
    }
  }
  void operator()(const MeshAreaLight& light) const {
    if (light.mesh == nullptr) {
      faults->Add(where, "has no mesh", "triangles that emit");
    } else {
      ValidateTriangles(*light.mesh, where, faults);
    }
    operator()<MeshAreaLight>(light);
  }
  void operator()(const EnvironmentLight& light) const {
    std::visit(*this, light.sky);
    operator()<EnvironmentLight>(light);
  }
  void operator()(const GradientSky& sky) const { CheckKeys(sky, where + "/gradient", faults); }
  void operator()(const QuadraticSky& sky) const {
    const std::string place = where + "/quadratic";
    const size_t before = faults->count();
    CheckKeys(sky, place, faults);
    if (faults->count() == before && SmallestValue(sky) < 0) {
      faults->Add(place, fmt::format("falls to {:g} in some direction", SmallestValue(sky)),
                  "constant + linear c + quadratic c^2 is at least 0 for c from -1 to 1");
    }
  }
  void operator()(const PictureSky& sky) const {
    CheckKeys(sky, where, faults);
    const bool whole = sky.picture != nullptr && sky.picture->width > 0 &&
                       sky.picture->height > 0 &&
                       sky.picture->rgb.size() == 3 * static_cast<size_t>(sky.picture->width) *
                                                      static_cast<size_t>(sky.picture->height);
    if (!whole) faults->Add(where + "/image", "holds no picture", "3 floats a texel");
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
