// SPDX-License-Identifier: Apache-2.0
// scene_io/read_lights.cc: the part "lights". Skies are read by read_skies.cc.
#include <cmath>
#include <string_view>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene_io/read_keys.h"
#include "scene_io/readers.h"

namespace nacre {
namespace {

// Lights with an extent are always sampled. Files of version 0.1 may say so, or ask for
// approximations instead, which were dropped because they were no faster than samples at the same
// error.
void ReadMode(JsonObject* object) {
  std::string mode;
  if (!object->Text("mode", &mode) || mode == "sampled") return;
  const JsonValue value = *object->Find("mode");
  if (mode == "fast") {
    value.AddFault("the fast mode is gone",
                   "leave \"mode\" out: samples reach the fast mode's error sooner");
  } else {
    FaultUnknownName(value, "mode", mode, {"sampled"});
  }
}

// For point and spot lights.
template <class Positional>
void ReadAttenuation(const JsonValue& value, Positional* light) {
  constexpr std::string_view kHint =
      R"("inverse_square", "none" or {"constant": c, "linear": l, "quadratic": q})";
  if (value.json.is_string()) {
    const auto word = value.json.get<std::string>();
    if (word == "inverse_square") {
      light->attenuation = Attenuation::InverseSquare();
    } else if (word == "none") {
      light->attenuation = Attenuation::None();
    } else {
      FaultUnknownName(value, "attenuation", word, {"inverse_square", "none"});
    }
    return;
  }
  JsonObject object(value, kHint);
  if (object.is_object()) light->attenuation = {0, 0, 0};
  ReadInnerKeys("attenuation", &object, light);
  object.RefuseOthers();
}

// Reads the members of a light beyond its keys, and derives what follows from the keys.
struct KindReader {
  JsonObject* object;
  const SceneContext& context;

  template <class Kind>
  void operator()(Kind& light) const {
    ReadKeys(object, &light);
    if constexpr (requires { light.attenuation; }) {
      if (const auto value = object->Find("attenuation")) ReadAttenuation(*value, &light);
    }
  }
  void operator()(SpotLight& light) const {
    constexpr double kUnset = -1;  // outside of its range
    light.inner_deg = kUnset;
    operator()<SpotLight>(light);
    if (light.inner_deg == kUnset) light.inner_deg = light.cutoff_deg;
  }
  void operator()(RectangleAreaLight& light) const {
    operator()<RectangleAreaLight>(light);
    if (!object->Find("up")) light.up = DefaultUp(light.facing);
  }
  void operator()(MeshAreaLight& light) const {
    light.mesh = ReadLightMesh(object, context);
    operator()<MeshAreaLight>(light);
  }
  void operator()(EnvironmentLight& light) const {
    ReadSky(object, context, &light);
    operator()<EnvironmentLight>(light);
  }

  // The default up vector: up, or, for a light that faces up or down, away from the viewer.
  static Vec3d DefaultUp(const Vec3d& facing) {
    const bool vertical = std::hypot(facing.x, facing.z) <= 1e-6 * std::abs(facing.y);
    return vertical ? Vec3d(0, 0, -1) : Vec3d(0, 1, 0);
  }
};

void ReadLight(const JsonValue& value, const SceneContext& context, Light* light) {
  std::vector<std::string_view> names;
  for (const LightKind& kind : LightKinds()) names.push_back(kind.name);
  JsonObject object(value);
  object.Require("type", fmt::format("one of: {}", fmt::join(names, ", ")));
  size_t type = 0;
  if (!object.Choice("type", names, &type)) return;
  light->kind = LightKinds()[type].make();
  std::visit(KindReader{&object, context}, light->kind);
  const bool is_ambient = std::holds_alternative<AmbientLight>(light->kind);
  if (!is_ambient) object.Boolean("shadows", &light->shadows);
  if (!is_ambient && !IsPunctual(*light)) ReadMode(&object);
  object.RefuseOthers();
}

}  // namespace

void ReadLights(const JsonValue& value, const SceneContext& context, std::vector<Light>* lights) {
  const JsonObject object(value, R"(lights by name: {"key": {"type": "point", ...}})");
  if (!object.is_object()) return;
  for (const auto& [name, json] : value.json.items()) {
    Light& light = lights->emplace_back();
    light.name = name;
    ReadLight({json, value.path.Member(name), value.faults}, context, &light);
  }
}

}  // namespace nacre
