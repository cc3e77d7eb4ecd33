// SPDX-License-Identifier: Apache-2.0
// scene_io/schema.cc: inserts the tables of material parameters and of keys, as JSON Schema, into
// the template; and answers queries about the schema.
#include "scene_io/schema.h"

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "scene/keys.h"
#include "scene/material_parameters.h"
#include "scene_io/read_keys.h"

namespace nacre {
namespace {

std::string Quoted(std::string_view text) { return nlohmann::json(text).dump(); }

// Writes three numbers as people do: a grey as one number.
std::string ValueText(const Vec3d& value, bool may_be_grey) {
  if (may_be_grey && value.x == value.y && value.y == value.z) return fmt::format("{}", value.x);
  return fmt::format("[{}, {}, {}]", value.x, value.y, value.z);
}

std::string NumberType(const Range& range, const char* type = "number") {
  return fmt::format(R"("type": "{}", "{}": {}, "{}": {})", type,
                     range.min_open ? "exclusiveMinimum" : "minimum", range.min,
                     range.max_open ? "exclusiveMaximum" : "maximum", range.max);
}

std::string Reference(const char* name) { return fmt::format(R"("$ref": "#/$defs/{}")", name); }

std::string EnumOf(std::span<const std::string_view> options) {
  std::vector<std::string> quoted;
  for (const std::string_view option : options) quoted.push_back(Quoted(option));
  return fmt::format(R"("enum": [{}])", fmt::join(quoted, ", "));
}

// The type of a number or a colour, as a reference if the template defines it.
std::string TypeOf(bool is_color, const Range& range) {
  if (range == limits::kUnit) return Reference(is_color ? "unit_color" : "unit");
  if (range == limits::kRadiance && is_color) return Reference("radiance");
  if (range == limits::kExponent && !is_color) return Reference("exponent");
  if (range == limits::kLength && !is_color) return Reference("length");
  if (range == limits::kCoordinate && !is_color) return Reference("coordinate");
  const std::string number = NumberType(range);
  if (!is_color) return number;
  return fmt::format(R"("anyOf": [{{ {0} }}, {{ "type": "array", "items": {{ {0} }}, )"
                     R"("minItems": 3, "maxItems": 3 }}])",
                     number);
}

// A property with this type; without a description or a default where these are empty.
std::string Property(std::string_view name, std::string_view meaning, const std::string& type,
                     const std::string& value = {}) {
  return fmt::format("{}: {{ {}{}{} }}", Quoted(name),
                     meaning.empty() ? "" : fmt::format(R"("description": {}, )", Quoted(meaning)),
                     type, value.empty() ? "" : fmt::format(R"(, "default": {})", value));
}

// A key's type, and its default value as text.
struct KeyText {
  std::string type, value;
};
KeyText TextOf(KeyForm form, const Range& range, std::span<const std::string_view> options,
               const Vec3d& value) {
  switch (form) {
    case KeyForm::kNumber:
      break;
    case KeyForm::kWhole:
      return {NumberType(range, "integer"), fmt::format("{}", value.x)};
    case KeyForm::kColor:
      return {TypeOf(true, range), ValueText(value, true)};
    case KeyForm::kPoint:
      return {Reference("point"), ValueText(value, false)};
    case KeyForm::kDirection:
      return {Reference("direction"), ValueText(value, false)};
    case KeyForm::kBoolean:
      return {R"("type": "boolean")", value.x != 0 ? "true" : "false"};
    case KeyForm::kChoice:
      return {EnumOf(options), Quoted(options[static_cast<size_t>(value.x)])};
  }
  return {TypeOf(false, range), fmt::format("{}", value.x)};
}

// The keys of a struct, or of the object `outer` in it, as properties, and the names of those that
// are required.
struct KeyTexts {
  std::vector<std::string> properties;
  std::string required;
};
template <class Owner>
KeyTexts TextsOf(const Owner& defaults, std::string_view outer = "") {
  KeyTexts texts;
  for (const SceneKey<Owner>& key : KeysFor(defaults)) {
    // The type of a camera is in the template.
    if (OuterName(key.name) != outer || key.name == "type") continue;
    const auto [type, value] = TextOf(key.form, key.range, key.options, key.get(defaults));
    const bool has_default = key.use == KeyUse::kOptional || key.form == KeyForm::kChoice;
    texts.properties.push_back(
        Property(InnerName(key.name), key.meaning, type, has_default ? value : ""));
    if (key.use == KeyUse::kRequired) texts.required += ", " + Quoted(InnerName(key.name));
  }
  return texts;
}

std::string DefinitionOf(const MaterialModel& model) {
  const Material defaults = model.make();
  std::vector<std::string> properties = {
      Property("model", "", fmt::format(R"("const": {})", Quoted(model.name)))};
  const bool has_file = std::holds_alternative<MeasuredMaterial>(defaults.model);
  if (has_file) {
    properties.push_back(Property("file",
                                  "A .binary of the MERL database or a .bsdf of EPFL's, in the "
                                  "scene's folder.",
                                  R"("type": "string")"));
  }
  for (const MaterialChoice& choice : model.choices) {
    const std::string value =
        choice.get != nullptr ? Quoted(choice.options[choice.get(defaults)]) : "";
    properties.push_back(Property(choice.name, choice.meaning, EnumOf(choice.options), value));
  }
  for (const MaterialParameter& parameter : model.parameters) {
    properties.push_back(Property(parameter.name, parameter.meaning,
                                  TypeOf(parameter.is_color, parameter.range),
                                  ValueText(Vec3d(parameter.get(defaults)), true)));
  }
  for (const MaterialMap& map : model.maps) {
    properties.push_back(Property(map.name, map.meaning, Reference("texture_name")));
  }
  for (const MaterialNormalMap& map : model.normal_maps) {
    properties.push_back(Property(map.name, map.meaning, Reference("normal_map")));
  }
  properties.push_back(Property("bump_map", "", Reference("bump_map")));
  return fmt::format(R"(    "{}_material": {{
      "title": {},
      "type": "object",
      "required": ["model"{}],
      "additionalProperties": false,
      "properties": {{
        {}
      }}
    }},
)",
                     model.name, Quoted(model.title), has_file ? R"(, "file")" : "",
                     fmt::join(properties, ",\n        "));
}

void Replace(std::string_view mark, const std::string& with, std::string* text) {
  text->replace(text->find(mark), mark.size(), with);
}

// Replaces the placeholders of a struct's keys.
void PutKeys(std::string_view name, const KeyTexts& texts, std::string* schema) {
  const std::string indent = ",\n        ";
  Replace(fmt::format("%KEYS {}%", name), fmt::format("{}", fmt::join(texts.properties, indent)),
          schema);
  const std::string required = fmt::format("%REQUIRED {}%", name);
  if (schema->find(required) != std::string::npos) Replace(required, texts.required, schema);
}

// Replaces "%LIGHT name: title%" by the definition of a kind of light. Kinds that have more than
// keys are in the template.
template <class Kind>
void PutLight(std::string_view name, const Kind& light, std::string* schema) {
  KeyTexts texts = TextsOf(light);
  const std::string mark = fmt::format("%LIGHT {}: ", name);
  const size_t begin = schema->find(mark);
  if (begin == std::string::npos) return PutKeys(fmt::format("{}_light", name), texts, schema);
  const auto add = [&](const char* property, const char* definition) {
    texts.properties.push_back(Property(property, "", Reference(definition)));
  };
  if constexpr (requires { light.attenuation; }) add("attenuation", "attenuation");
  if constexpr (!std::is_same_v<Kind, AmbientLight>) {
    if (!IsPunctual({.name = {}, .kind = light})) add("mode", "light_mode");
    add("shadows", "light_shadows");
  }
  const size_t title = begin + mark.size(), end = schema->find('%', title);
  const std::string definition =
      fmt::format(R"("{0}_light": {{
      "title": {1},
      "type": "object",
      "required": ["type"{2}],
      "additionalProperties": false,
      "properties": {{
        "type": {{ "const": "{0}" }},
        {3}
      }}
    }})",
                  name, Quoted(schema->substr(title, end - title)), texts.required,
                  fmt::join(texts.properties, ",\n        "));
  schema->replace(begin, end + 1 - begin, definition);
}

void PutAllKeys(std::string* schema) {
  Camera orthographic;
  orthographic.projection = Projection::kOrthographic;
  PutKeys("perspective_camera", TextsOf(Camera{}), schema);
  PutKeys("orthographic_camera", TextsOf(orthographic), schema);
  PutKeys("image", TextsOf(ImageSettings{}), schema);
  PutKeys("filter", TextsOf(ImageSettings{}, "filter"), schema);
  PointLight dark;
  dark.attenuation = {0, 0, 0};  // the value from which an object with only some of the terms
                                 // starts
  PutKeys("attenuation", TextsOf(dark, "attenuation"), schema);
  std::vector<std::string> references;
  for (const LightKind& kind : LightKinds()) {
    std::visit([&](const auto& light) { PutLight(kind.name, light, schema); }, kind.make());
    references.push_back(fmt::format("{{ \"$ref\": \"#/$defs/{}_light\" }}", kind.name));
  }
  Replace("%LIGHT_REFERENCES%", fmt::format("{}", fmt::join(references, ",\n        ")), schema);
  PutKeys("constant_sky", TextsOf(ConstantSky{}), schema);
  PutKeys("gradient_sky", TextsOf(GradientSky{}), schema);
  PutKeys("quadratic_sky", TextsOf(QuadraticSky{}), schema);
  PutKeys("picture_sky", TextsOf(PictureSky{}), schema);
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
  PutAllKeys(&schema);
  return schema;
}

// Collects the schema itself, the schemas that it refers to, and its alternatives.
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
