// SPDX-License-Identifier: Apache-2.0
#include "cli/plot_inputs.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cli/outputs.h"
#include "scene_io/load_scene.h"
#include "scene_io/sheet_axis.h"

namespace nacre {
namespace {

using Json = nlohmann::ordered_json;

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
  return LoadSceneText(JsonText(scene), "nacre plot", ".", {});
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
  const std::string nearest = NearestName(name, names);
  throw Error(ExitCode::kBadInput, inputs.scene, fmt::format("has no {} \"{}\"", what, name),
              !nearest.empty() ? fmt::format("did you mean \"{}\"?", nearest)
                               : fmt::format("it has {}", fmt::join(names, ", ")));
}

bool IsJson(const std::string& text) { return text.find('{') != std::string::npos; }

template <class Item>
std::vector<std::string> ItemNames(const std::vector<Item>& items) {
  std::vector<std::string> names;
  names.reserve(items.size());
  for (const Item& item : items) names.push_back(item.name);
  return names;
}

// Curves show a single set of numbers: the constant factors, without maps.
NamedMaterial Prepare(const std::string& label, const Material& material) {
  NamedMaterial named{label, PrepareMaterial(material)};
  DropMaps(&named.material);
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
    if (scene && !IsJson(item.text)) {
      const std::vector<Item>& all = (*scene).*items;
      const auto at = std::find_if(all.begin(), all.end(),
                                   [&](const Item& one) { return one.name == item.text; });
      if (at == all.end()) FailUnknown(inputs, what, item.text, ItemNames(all));
      found.emplace_back(item.text, *at);
      continue;
    }
    const Json object = parse(item.text);
    const std::string label = item.label.empty() ? LabelOf(object, kind) : item.label;
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

}  // namespace nacre
