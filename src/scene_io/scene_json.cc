// SPDX-License-Identifier: Apache-2.0
#include "scene_io/scene_json.h"

#include <cstdlib>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "brdf/fresnel.h"
#include "scene/material_parameters.h"
#include "scene_io/read_keys.h"

namespace nacre {
namespace {

double Rounded(double value) { return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr); }

Json RoundedColorJson(const Rgb& rgb) {
  const Json color = {Rounded(rgb.x), Rounded(rgb.y), Rounded(rgb.z)};
  return color[0] == color[1] && color[1] == color[2] ? color[0] : color;
}

bool DoesNothing(const MaterialParameter& parameter, const Rgb& value) {
  return (parameter.name == "emission" && value == Rgb(0)) ||
         (parameter.name == "dielectric_f0" && value == Rgb(kDielectricF0)) ||
         (parameter.name == "specular" && value == Rgb(1)) ||
         (parameter.name == "opacity" && value == Rgb(1)) ||
         (parameter.name == "opacity_cutoff" && value == Rgb(Material().opacity_cutoff)) ||
         (parameter.name == "f82_tint" && value == Rgb(1));
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

Json MaterialJson(const Material& material) {
  const MaterialModel& model = *ModelOf(material);
  Json json = {{"model", model.name}};
  if (const auto* measured = std::get_if<MeasuredMaterial>(&material.model)) {
    json["file"] = measured->file;
  }
  for (const MaterialParameter& parameter : model.parameters) {
    const Rgb value = parameter.get(material);
    if (!DoesNothing(parameter, value)) json[std::string(parameter.name)] = RoundedColorJson(value);
  }
  const Material defaults = model.make();
  for (const MaterialChoice& choice : model.choices) {
    if (choice.get == nullptr || choice.get(material) == choice.get(defaults)) continue;
    json[std::string(choice.name)] = choice.options[choice.get(material)];
  }
  return json;
}

std::string DescribeMaterial(const Json& material) {
  std::string text;
  for (const auto& [key, value] : material.items()) {
    if (key == "model") continue;
    text += text.empty() ? "" : ", ";
    text += key + " ";
    if (value.is_array()) {
      for (size_t i = 0; i < value.size(); ++i) {
        text += fmt::format("{}{:.4g}", i > 0 ? " " : "", value[i].get<double>());
      }
    } else {
      text += value.is_number()   ? fmt::format("{:.4g}", value.get<double>())
              : value.is_string() ? value.get<std::string>()
                                  : JsonText(value);
    }
  }
  const std::string model = material.value("model", "material");
  return text.empty() ? model : model + ": " + text;
}

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
  put["background"] = KeyValueJson(KeyForm::kColor, {}, Vec3d(scene.background));
  put["nacre"] = 1;
  return put;
}

}  // namespace nacre
