// SPDX-License-Identifier: Apache-2.0
// scene_io/read_lights.cc: the part "lights". Those with an extent: read_area_lights.cc.
#include <array>

#include "scene_io/readers.h"

namespace nacre {
namespace {

// Lights with an extent are always sampled. Files of version 0.1 may say so, and might have asked
// for approximations in place of samples, which were dropped: they were no faster than samples at
// the same error.
void ReadMode(JsonObject* object) {
  std::string mode;
  if (!object->Text("mode", &mode) || mode == "sampled") return;
  const JsonValue value{*object->Find("mode"), object->path().Member("mode"), object->faults()};
  if (mode == "fast") {
    value.AddFault("the fast mode is gone",
                   "leave \"mode\" out: samples reach the fast mode's error sooner");
  } else {
    FaultUnknownName(value, "mode", mode, {"sampled"});
  }
}

enum class LightType {
  kAmbient,
  kDirectional,
  kPoint,
  kSpot,
  kSphere,
  kRectangle,
  kDisk,
  kMesh,
  kEnvironment
};
constexpr std::array<std::string_view, 9> kLightTypes = {"ambient", "directional", "point",
                                                         "spot",    "sphere",      "rectangle",
                                                         "disk",    "mesh",        "environment"};

void ReadAttenuation(const JsonValue& value, Attenuation* attenuation) {
  constexpr std::string_view kHint =
      R"("inverse_square", "none" or {"constant": c, "linear": l, "quadratic": q})";
  if (value.json.is_string()) {
    const auto word = value.json.get<std::string>();
    if (word == "inverse_square") {
      *attenuation = Attenuation::InverseSquare();
    } else if (word == "none") {
      *attenuation = Attenuation::None();
    } else {
      FaultUnknownName(value, "attenuation", word, {"inverse_square", "none"});
    }
    return;
  }
  JsonObject object(value, kHint);
  if (object.is_object()) *attenuation = {0, 0, 0};
  object.Number("constant", limits::kAttenuation, &attenuation->constant);
  object.Number("linear", limits::kAttenuation, &attenuation->linear);
  object.Number("quadratic", limits::kAttenuation, &attenuation->quadratic);
  object.RefuseOthers();
}

// What point and spot lights have in common.
template <typename PointOrSpot>
void ReadPosition(JsonObject* object, PointOrSpot* light) {
  ReadRequiredPoint(object, "position", "[x, y, z]", &light->position);
  ReadRadiance(object, "intensity", "radiant intensity, [r, g, b] or grey", &light->intensity);
  if (const Json* attenuation = object->Find("attenuation")) {
    ReadAttenuation({*attenuation, object->path().Member("attenuation"), object->faults()},
                    &light->attenuation);
  }
}

constexpr std::string_view kDirectionHint = "[x, y, z], from the light towards the scene";

AmbientLight ReadAmbient(JsonObject* object) {
  AmbientLight light;
  ReadRadiance(object, "radiance", "[r, g, b] or grey, from every direction", &light.radiance);
  return light;
}

DirectionalLight ReadDirectional(JsonObject* object) {
  DirectionalLight light;
  ReadRequiredPoint(object, "direction_of_travel", kDirectionHint, &light.direction_of_travel);
  ReadRadiance(object, "irradiance", "[r, g, b] or grey, on a surface facing the light",
               &light.irradiance);
  return light;
}

PointLight ReadPointLight(JsonObject* object) {
  PointLight light;
  ReadPosition(object, &light);
  return light;
}

SpotLight ReadSpot(JsonObject* object) {
  SpotLight light;
  ReadPosition(object, &light);
  ReadRequiredPoint(object, "direction_of_travel", kDirectionHint, &light.direction_of_travel);
  object->Number("cutoff_deg", limits::kCutoffDeg, &light.cutoff_deg);
  light.inner_deg = light.cutoff_deg;
  object->Number("inner_deg", limits::kInnerDeg, &light.inner_deg);
  object->Number("exponent", limits::kExponent, &light.exponent);
  constexpr std::array<std::string_view, 2> kEdges = {"smoothstep", "square"};
  size_t edge = 0;
  if (object->Choice("edge", kEdges, &edge)) light.edge = static_cast<SpotEdge>(edge);
  return light;
}

void ReadLight(const JsonValue& value, const SceneContext& context, Light* light) {
  JsonObject object(value);
  object.Require(
      "type",
      "one of: ambient, directional, point, spot, sphere, rectangle, disk, mesh, environment");
  size_t type = 0;
  if (!object.Choice("type", kLightTypes, &type)) return;
  switch (static_cast<LightType>(type)) {
    case LightType::kAmbient:
      light->kind = ReadAmbient(&object);
      break;
    case LightType::kDirectional:
      light->kind = ReadDirectional(&object);
      break;
    case LightType::kPoint:
      light->kind = ReadPointLight(&object);
      break;
    case LightType::kSpot:
      light->kind = ReadSpot(&object);
      break;
    case LightType::kSphere:
      light->kind = ReadSphereArea(&object);
      break;
    case LightType::kRectangle:
      light->kind = ReadRectangleArea(&object);
      break;
    case LightType::kDisk:
      light->kind = ReadDiskArea(&object);
      break;
    case LightType::kMesh:
      light->kind = ReadMeshArea(&object, context);
      break;
    case LightType::kEnvironment:
      light->kind = ReadEnvironment(&object, context);
      break;
  }
  const auto kind = static_cast<LightType>(type);
  if (kind != LightType::kAmbient) object.Boolean("shadows", &light->shadows);
  if (kind == LightType::kSphere || kind == LightType::kRectangle || kind == LightType::kDisk ||
      kind == LightType::kMesh || kind == LightType::kEnvironment) {
    ReadMode(&object);
  }
  object.RefuseOthers();
}

}  // namespace

void ReadLights(const JsonValue& value, const SceneContext& context, std::vector<Light>* lights) {
  const JsonObject object(value, R"(lights by name: {"key": {"type": "point", ...}})");
  if (!object.is_object()) return;
  for (const auto& [name, json] : value.json.items()) {
    Light& light = lights->emplace_back();
    light.name = name;
    ReadLight({json, object.path().Member(name), object.faults()}, context, &light);
  }
}

}  // namespace nacre
