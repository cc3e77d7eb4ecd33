// SPDX-License-Identifier: Apache-2.0
#include "cli/plot_inputs.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "cli/given_material.h"
#include "cli/outputs.h"
#include "scene_io/load_scene.h"
#include "scene_io/materialx.h"
#include "scene_io/sheet_axis.h"

namespace nacre {
namespace {

// Describes {"model": "phong", "shininess": 64} as "phong, shininess 64". `kind` is "model" or
// "type".
std::string LabelOf(const Json& object, const char* kind) {
  const auto text = [](const Json& value) {
    return value.is_string() ? value.get<std::string>() : JsonText(value);
  };
  const auto found = object.find(kind);
  std::string label = found != object.end() ? text(*found) : "";
  for (const auto& [key, value] : object.items()) {
    if (key != kind) label += fmt::format(", {} {}", key, text(value));
  }
  std::replace(label.begin(), label.end(), '_', ' ');
  return label;
}

Json ParseLight(const std::string& option, const std::string& text) {
  Json light = TryParseJson(text).value_or(Json());
  if (!light.is_object()) {
    throw Error(ExitCode::kUsage, option, "\"" + text + "\" is not a light",
                "give JSON, e.g. '{\"type\": \"point\", \"intensity\": 1}', or a name and --scene");
  }
  return light;
}

// Reads an object of the command line as an item of a scene file; `key` names the part.
Scene SceneOf(const char* key, const Json& object) {
  const Json scene = {{"nacre", 1}, {key, {{"given", object}}}};
  return LoadSceneText(JsonText(scene), "nacre plot", ".", OptionsForGiven(object));
}

std::optional<Scene> LoadInputScene(const PlotInputs& inputs) {
  if (inputs.scene.empty()) return std::nullopt;
  LoadOptions options;
  options.allow_paths = inputs.allow_paths;
  std::vector<std::string> read = {inputs.scene};
  options.on_file = [&](const std::filesystem::path& file) { read.push_back(file.string()); };
  Scene scene = LoadScene(inputs.scene, options);
  CheckOutputsAreNoInputs(inputs.outputs, read);
  return scene;
}

[[noreturn]] void FailUnknown(const PlotInputs& inputs, const char* what, const std::string& name,
                              const std::vector<std::string>& names) {
  throw Error(ExitCode::kBadInput, inputs.scene, fmt::format("has no {} \"{}\"", what, name),
              NearestHint(name, names, fmt::format("it has {}", fmt::join(names, ", "))));
}

bool IsJson(const std::string& text) { return text.find('{') != std::string::npos; }

// Curves show a single set of numbers: the constant factors, without maps.
NamedMaterial Prepare(const std::string& label, const Material& material) {
  NamedMaterial named{label, PrepareWithoutMaps(material)};
  if (std::holds_alternative<std::monostate>(named.material.model)) {
    throw Error(ExitCode::kBadInput, label, "a split has no reflection model of its own",
                "name one of its materials");
  }
  return named;
}

// The items that `wanted` names in the scene, or defines itself. `parse` converts an option's text
// to JSON.
template <class Item, class Parse>
std::vector<std::pair<std::string, Item>> Collect(const PlotInputs& inputs, const char* key,
                                                  const char* what, const char* kind,
                                                  const std::vector<PlotItem>& wanted,
                                                  std::vector<Item> Scene::*items,
                                                  const Parse& parse) {
  const std::optional<Scene> scene = LoadInputScene(inputs);
  std::vector<std::pair<std::string, Item>> found;
  if (scene && wanted.empty()) {
    for (const Item& item : (*scene).*items) found.emplace_back(item.name, item);
    return found;
  }
  for (const PlotItem& item : wanted) {
    if (scene && !IsJson(item.text) && !IsMaterialXReference(item.text)) {
      const std::vector<Item>& all = (*scene).*items;
      const auto at = std::ranges::find(all, item.text, &Item::name);
      if (at == all.end()) FailUnknown(inputs, what, item.text, NamesOf(all));
      found.emplace_back(item.text, *at);
      continue;
    }
    Json object = parse(item.text);
    const bool is_file = IsMaterialXReference(item.text);
    const std::string label = !item.label.empty() ? item.label
                              : is_file           ? MaterialLabel(object)
                                                  : LabelOf(object, kind);
    if (is_file) object.erase("name");
    const Scene own = SceneOf(key, object);
    found.emplace_back(label, (own.*items).front());
  }
  return found;
}

std::vector<PlotItem> Wanted(const PlotInputs& inputs, const std::vector<std::string>& texts,
                             const std::vector<PlotItem>& defaults) {
  if (texts.empty()) return inputs.scene.empty() ? defaults : std::vector<PlotItem>();
  std::vector<PlotItem> wanted;
  wanted.reserve(texts.size());
  for (const std::string& text : texts) wanted.push_back({"", text});
  return wanted;
}

PlotItem Metal(double roughness, const std::string& rest, const std::string& label) {
  return {label, fmt::format(R"({{"model": "metallic_roughness", "base_color": 1, "metallic": 1, )"
                             R"("roughness": {}{}}})",
                             roughness, rest)};
}

}  // namespace

std::vector<NamedMaterial> ReadPlotMaterials(const PlotInputs& inputs,
                                             const std::vector<PlotItem>& defaults) {
  const bool all = inputs.materials.empty() && !inputs.scene.empty();
  std::vector<NamedMaterial> materials;
  for (const auto& [label, material] :
       Collect(inputs, "materials", "material", "model", Wanted(inputs, inputs.materials, defaults),
               &Scene::materials,
               [](const std::string& text) { return ParseMaterialText("--material", text); })) {
    // When all are drawn, splits, which have no model, are skipped.
    if (all && std::holds_alternative<SplitMaterial>(material.model)) continue;
    materials.push_back(Prepare(label, material));
  }
  return materials;
}

std::vector<Light> ReadPlotLights(const PlotInputs& inputs, const std::vector<PlotItem>& defaults) {
  std::vector<Light> lights;
  for (const auto& [label, light] : Collect(
           inputs, "lights", "light", "type", Wanted(inputs, inputs.lights, defaults),
           &Scene::lights, [](const std::string& text) { return ParseLight("--light", text); })) {
    lights.push_back(light);
    lights.back().name = label;
  }
  return lights;
}

std::vector<PlotItem> DefaultModels() {
  return {
      {"Lambert", R"({"model": "lambert", "albedo": 0.5})"},
      {"Phong, n = 32", R"({"model": "phong", "kd": 0.5, "ks": 0.3, "shininess": 32})"},
      {"Blinn-Phong, n = 128",
       R"({"model": "blinn_phong", "kd": 0.5, "ks": 0.3, "shininess": 128})"},
      {"GGX dielectric, roughness 0.35",
       R"({"model": "metallic_roughness", "base_color": 0.5, "roughness": 0.35})"},
      {"GGX metal, roughness 0.5",
       R"({"model": "metallic_roughness", "base_color": 0.9, "metallic": 1, "roughness": 0.5})"},
  };
}

std::vector<PlotItem> DefaultDistributions() {
  std::vector<PlotItem> items;
  for (const double roughness : {0.1, 0.2, 0.4, 0.7, 1.0}) {
    items.push_back(Metal(roughness, "", fmt::format("GGX, roughness {}", roughness)));
  }
  // The exponent 2 / alpha^2 - 2 gives the same peak as roughness 0.4.
  items.push_back({"Blinn-Phong, n = 76", R"({"model": "blinn_phong", "shininess": 76})"});
  return items;
}

std::vector<PlotItem> DefaultMaskings() {
  std::vector<PlotItem> items;
  for (const double roughness : {0.3, 0.8}) {
    for (const char* form : {"height_correlated", "separable", "schlick_direct", "schlick_ibl"}) {
      items.push_back(Metal(roughness, fmt::format(R"(, "shadowing": "{}")", form),
                            fmt::format("{}, roughness {}", form, roughness)));
    }
  }
  return items;
}

std::vector<PlotItem> DefaultAlbedos() {
  const std::string single = R"(, "compensation": "none")";
  return {
      Metal(0.4, single, "metal, roughness 0.4, one bounce"),
      Metal(0.7, single, "metal, roughness 0.7, one bounce"),
      Metal(1, single, "metal, roughness 1, one bounce"),
      Metal(1, "", "metal, roughness 1, compensated"),
      {"dielectric, base by 1 - F(v.h)",
       R"({"model": "metallic_roughness", "base_color": 1, "roughness": 0.3, )"
       R"("diffuse_coupling": "one_minus_fresnel"})"},
      {"dielectric, base by albedo",
       R"({"model": "metallic_roughness", "base_color": 1, "roughness": 0.3})"},
  };
}

std::vector<PlotItem> DefaultInterfaces() {
  return {
      {"Schlick's curve, F0 = 0.04", R"({"model": "metallic_roughness"})"},
      {"glass (1.5), exact", R"({"model": "dielectric", "preset": "glass"})"},
      {"diamond (2.417), exact", R"({"model": "dielectric", "preset": "diamond"})"},
      {"iron, exact", R"({"model": "conductor", "preset": "iron"})"},
      {"gold, exact", R"({"model": "conductor", "preset": "gold"})"},
      {"aluminium, exact", R"({"model": "conductor", "preset": "aluminium"})"},
  };
}

// All have intensity 1 at a large distance.
std::vector<PlotItem> DefaultLights() {
  return {
      {"point, 1 / d²", R"({"type": "point", "position": [0, 0, 0], "intensity": 1})"},
      {"point, 1 / (1 + 0.1 d²)",
       R"({"type": "point", "position": [0, 0, 0], "intensity": 1, )"
       R"("attenuation": {"constant": 1, "linear": 0, "quadratic": 0.1}})"},
      {"sphere, radius 0.5",
       R"({"type": "sphere", "center": [0, 0, 0], "radius": 0.5, "radiance": 1.2732395447351628})"},
      {"disk, radius 1",
       R"({"type": "disk", "center": [0, 0, 0], "facing": [0, -1, 0], "radius": 1, )"
       R"("radiance": 0.3183098861837907})"},
      {"rectangle, 4 by 0.25",
       R"({"type": "rectangle", "center": [0, 0, 0], "facing": [0, -1, 0], "up": [0, 0, -1], )"
       R"("width": 4, "height": 0.25, "radiance": 1})"},
  };
}

}  // namespace nacre
