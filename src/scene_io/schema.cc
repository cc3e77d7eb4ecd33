// SPDX-License-Identifier: Apache-2.0
// scene_io/schema.cc: SceneSchema() of load_scene.h: what the table of material parameters says of
// the material models, as JSON Schema, put into the rest of it; and what it says of a place.
#include "scene_io/schema.h"

#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "scene/material_parameters.h"
#include "scene_io/load_scene.h"
#include "scene_io/schema_template.h"

namespace nacre {
namespace {

std::string Quoted(std::string_view text) { return nlohmann::json(text).dump(); }

// A number or a colour as people write it: a grey as one number.
std::string ValueText(const Rgb& value) {
  if (value.x == value.y && value.y == value.z) return fmt::format("{}", value.x);
  return fmt::format("[{}, {}, {}]", value.x, value.y, value.z);
}

std::string NumberType(const Range& range) {
  return fmt::format(R"("type": "number", "{}": {}, "{}": {})",
                     range.min_open ? "exclusiveMinimum" : "minimum", range.min,
                     range.max_open ? "exclusiveMaximum" : "maximum", range.max);
}

// What values a parameter takes: by reference, where the rest of the schema defines it.
std::string TypeOf(const MaterialParameter& parameter) {
  const auto reference = [](const char* name) {
    return fmt::format(R"("$ref": "#/$defs/{}")", name);
  };
  const Range& range = parameter.range;
  if (range == limits::kUnit) return reference(parameter.is_color ? "unit_color" : "unit");
  if (range == limits::kRadiance && parameter.is_color) return reference("radiance");
  if (range == limits::kExponent && !parameter.is_color) return reference("exponent");
  const std::string number = NumberType(range);
  if (!parameter.is_color) return number;
  return fmt::format(R"("anyOf": [{{ {0} }}, {{ "type": "array", "items": {{ {0} }}, )"
                     R"("minItems": 3, "maxItems": 3 }}])",
                     number);
}

std::string PropertyOf(const MaterialParameter& parameter, const Material& defaults) {
  return fmt::format(R"({}: {{ "description": {}, {}, "default": {} }})", Quoted(parameter.name),
                     Quoted(parameter.meaning), TypeOf(parameter),
                     ValueText(parameter.get(defaults)));
}

std::string PropertyOf(const MaterialChoice& choice, const Material& defaults) {
  std::vector<std::string> options;
  for (const std::string_view option : choice.options) options.push_back(Quoted(option));
  std::string value;
  if (choice.get != nullptr)
    value = fmt::format(R"(, "default": {})", options[choice.get(defaults)]);
  return fmt::format(R"({}: {{ "description": {}, "enum": [{}]{} }})", Quoted(choice.name),
                     Quoted(choice.meaning), fmt::join(options, ", "), value);
}

std::string PropertyOf(const MaterialMap& map) {
  return fmt::format(R"({}: {{ "description": {}, "$ref": "#/$defs/texture_name" }})",
                     Quoted(map.name), Quoted(map.meaning));
}

std::string DefinitionOf(const MaterialModel& model) {
  const Material defaults = model.make();
  std::vector<std::string> properties = {
      fmt::format(R"("model": {{ "const": {} }})", Quoted(model.name))};
  for (const MaterialChoice& choice : model.choices) {
    properties.push_back(PropertyOf(choice, defaults));
  }
  for (const MaterialParameter& parameter : model.parameters) {
    properties.push_back(PropertyOf(parameter, defaults));
  }
  for (const MaterialMap& map : model.maps) properties.push_back(PropertyOf(map));
  for (const MaterialNormalMap& row : model.normal_maps) {
    const std::string meaning =
        row.meaning.empty() ? "" : fmt::format(R"("description": {}, )", Quoted(row.meaning));
    properties.push_back(
        fmt::format(R"("{}": {{ {}"$ref": "#/$defs/normal_map" }})", row.name, meaning));
  }
  properties.emplace_back(R"("bump_map": { "$ref": "#/$defs/bump_map" })");
  return fmt::format(R"(    "{}_material": {{
      "title": {},
      "type": "object",
      "required": ["model"],
      "additionalProperties": false,
      "properties": {{
        {}
      }}
    }},
)",
                     model.name, Quoted(model.title), fmt::join(properties, ",\n        "));
}

void Replace(std::string_view mark, const std::string& with, std::string* text) {
  text->replace(text->find(mark), mark.size(), with);
}

std::string MakeSchema() {
  std::string references, models;
  for (const MaterialModel& model : MaterialModels()) {
    references += fmt::format("        {{ \"$ref\": \"#/$defs/{}_material\" }},\n", model.name);
    models += DefinitionOf(model);
  }
  std::string schema(SchemaTemplate());
  Replace("%MATERIAL_REFERENCES%", references, &schema);
  Replace("%MATERIAL_MODELS%", models, &schema);
  return schema;
}

// Adds the schema itself, what it refers to, and its alternatives.
void AddAlternatives(const nlohmann::json& root, const nlohmann::json& schema,
                     std::vector<const nlohmann::json*>* all) {
  all->push_back(&schema);
  if (const auto reference = schema.find("$ref"); reference != schema.end()) {
    const auto pointer = reference->get<std::string>().substr(1);  // after the #
    AddAlternatives(root, root.at(nlohmann::json::json_pointer(pointer)), all);
  }
  for (const char* const key : {"anyOf", "oneOf"}) {
    if (!schema.contains(key)) continue;
    for (const nlohmann::json& one : schema.at(key)) AddAlternatives(root, one, all);
  }
}

// The schema of a member or an element, or null.
const nlohmann::json* Step(const nlohmann::json& schema, const std::string& token) {
  const auto properties = schema.find("properties");
  if (properties != schema.end() && properties->contains(token)) return &properties->at(token);
  for (const char* const key : {"additionalProperties", "items"}) {
    if (schema.contains(key) && schema.at(key).is_object()) return &schema.at(key);
  }
  return nullptr;
}

std::string TypeOfValue(const nlohmann::json& value) {
  return value.is_string() ? "string" : value.is_boolean() ? "boolean" : "number";
}

}  // namespace

std::vector<std::string> SchemaTypesAt(const std::vector<std::string>& tokens) {
  static const nlohmann::json root = nlohmann::json::parse(SceneSchema());
  std::vector<const nlohmann::json*> schemas;
  AddAlternatives(root, root, &schemas);
  for (const std::string& token : tokens) {
    std::vector<const nlohmann::json*> next;
    for (const nlohmann::json* schema : schemas) {
      if (const nlohmann::json* const step = Step(*schema, token)) {
        AddAlternatives(root, *step, &next);
      }
    }
    schemas = std::move(next);
  }
  std::set<std::string> types;
  for (const nlohmann::json* schema : schemas) {
    if (schema->contains("type")) types.insert(schema->at("type").get<std::string>());
    if (schema->contains("const")) types.insert(TypeOfValue(schema->at("const")));
    if (!schema->contains("enum")) continue;
    for (const nlohmann::json& value : schema->at("enum")) types.insert(TypeOfValue(value));
  }
  return {types.begin(), types.end()};
}

std::string_view SceneSchema() {
  static const std::string schema = MakeSchema();
  return schema;
}

}  // namespace nacre
