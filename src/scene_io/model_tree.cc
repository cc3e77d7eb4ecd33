// SPDX-License-Identifier: Apache-2.0
#include "scene_io/model_tree.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "scene/material_parameters.h"
#include "scene_io/material_json.h"
#include "scene_io/read_keys.h"

namespace nacre {
namespace {

Json ColorJson(const Rgb& color) {
  if (color.x == color.y && color.y == color.z) return color.x;
  return {color.x, color.y, color.z};
}

// Converts the kind of a light. Leaves out members that a model's lights do not have, and pictures.
struct KindJson {
  template <class Kind>
  Json operator()(const Kind& light) const {
    Json json = KeysJson(light);
    if constexpr (requires { light.attenuation; }) {
      if (light.attenuation == Attenuation::InverseSquare()) json.erase("attenuation");
    }
    return json;
  }
  Json operator()(const EnvironmentLight& light) const {
    const auto* const room = std::get_if<PictureSky>(&light.sky);
    if (room == nullptr) return {};
    Json json = KeysJson(*room);
    json.update(KeysJson(light));
    return json;
  }
  Json operator()(const MeshAreaLight&) const { return {}; }
};

}  // namespace

Json ModelLightJson(const Light& light) {
  const Json keys = std::visit(KindJson{}, light.kind);
  if (keys.is_null()) return {};
  Json json = {{"type", KindOf(light).name}};
  json.update(keys);
  if (!light.shadows) json["shadows"] = false;
  return json;
}

void AddMaterials(const Scene& scene, Json* put) {
  Json& materials = (*put)["materials"];
  for (const Material& material : scene.materials) {
    if (ModelOf(material) == nullptr) continue;
    Json whole = MaterialJson(material);
    if (materials.contains(material.name)) whole.update(materials[material.name]);
    materials[material.name] = std::move(whole);
  }
}

// An override that has a type is a whole light. Others have set single members, which the scene's
// light includes already, or are null, and have removed the light.
void AddLights(const Scene& scene, Json* put) {
  Json own = put->value("lights", Json::object()), lights = Json::object();
  for (const auto& [name, light] : own.items()) {
    if (light.is_object() && light.contains("type")) lights[name] = light;
  }
  for (const Light& light : scene.lights) {
    if (lights.contains(light.name)) continue;
    Json whole = ModelLightJson(light);
    if (!whole.is_null()) lights[light.name] = std::move(whole);
  }
  (*put)["lights"] = std::move(lights);
}

Json ModelTree(const Scene& scene, const ImageSettings& image, Json put) {
  AddMaterials(scene, &put);
  AddLights(scene, &put);
  put["camera"] = KeysJson(scene.camera);
  Json whole = KeysJson(image);
  whole.update(put.value("image", Json::object()));
  put["image"] = std::move(whole);
  put["background"] = ColorJson(scene.background);
  put["nacre"] = 1;
  return put;
}

}  // namespace nacre
