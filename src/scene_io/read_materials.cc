// SPDX-License-Identifier: Apache-2.0
// scene_io/read_materials.cc: the part "materials", and materials wherever a shape names one.
#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/material_parameters.h"
#include "scene_io/materialx.h"
#include "scene_io/readers.h"

namespace nacre {
namespace {

constexpr std::string_view kSplit = "split";

void ReadParameters(const MaterialModel& model, JsonObject* object, Material* material) {
  // Choices come first: a preset sets parameters that the object may set again.
  for (const MaterialChoice& choice : model.choices) {
    size_t option = 0;
    if (object->Choice(choice.name, choice.options, &option)) choice.set(*material, option);
  }
  for (const MaterialParameter& parameter : model.parameters) {
    const auto value = object->Find(parameter.name);
    Rgb number_or_color;
    if (value && ReadParameterValue(*value, parameter, &number_or_color)) {
      parameter.set(*material, number_or_color);
    }
  }
}

// The required member `name`, which must be an array; nullopt if it is not.
std::optional<JsonValue> RequireArray(JsonObject* object, std::string_view name,
                                      std::string_view hint) {
  const auto value = object->Require(name, hint);
  if (!value || !value->Expect(value->json.is_array(), "an array", hint)) return std::nullopt;
  return value;
}

SplitMaterial ReadSplit(JsonObject* object, SceneContext* context) {
  SplitMaterial split;
  if (const auto at = RequireArray(object, "at", "fractions of the image's width, ascending")) {
    for (size_t i = 0; i < at->json.size(); ++i) {
      ReadNumber(at->Element(i), limits::kSplitAt, &split.at.emplace_back());
    }
  }
  if (const auto materials = RequireArray(object, "materials", "one for each band, by name")) {
    for (size_t i = 0; i < materials->json.size(); ++i) {
      ReadMaterialId(materials->Element(i), context, &split.materials.emplace_back());
    }
  }
  return split;
}

// The material of a MaterialX document, read once for a scene; nullptr, and a fault is added, if it
// cannot be read. *folder is where the files that it names are looked for.
const MaterialXMaterial* FindMaterialX(const JsonValue& value, const std::string& file,
                                       const std::string& name, SceneContext* context,
                                       std::filesystem::path* folder) {
  const auto known = context->materialx.find({file, name});
  try {
    const std::filesystem::path path = ResolveReference(context->folder, file, context->references);
    const auto& trusted = context->references.trusted;
    // What the user has chosen himself may be anywhere, but names files of its own folder.
    const bool is_trusted = std::find(trusted.begin(), trusted.end(), path) != trusted.end();
    *folder =
        is_trusted ? context->folder / std::filesystem::path(file).parent_path() : context->folder;
    if (known != context->materialx.end()) return &known->second;
    MaterialXMaterial material = ReadMaterialX(
        *folder, is_trusted ? path.filename().string() : file, name, context->references);
    if (context->on_warning) {
      for (const std::string& note : material.notes) context->on_warning(note);
    }
    return &context->materialx.emplace(std::pair(file, name), std::move(material)).first->second;
  } catch (const Error& error) {
    AddFileFaults(error, value);
    return nullptr;
  }
}

void ReadMaterial(const JsonValue& value, SceneContext* context, Material* material);

// Reads {"file": "x.mtlx", "material": "gold"}, whose other members change what the document says.
void ReadMaterialOfFile(const JsonValue& value, SceneContext* context, Material* material) {
  std::string file, name;
  {
    JsonObject object(value);
    if (!object.Text("file", &file)) return;
    if (object.Find("material") && !object.Text("material", &name)) return;
  }
  const JsonValue place{value.json.at("file"), value.path.Member("file"), value.faults};
  if (!IsMaterialXFile(file)) {
    return place.AddFault("is no MaterialX document", "a file of the extension .mtlx");
  }
  std::filesystem::path folder;
  const MaterialXMaterial* const read = FindMaterialX(place, file, name, context, &folder);
  if (read == nullptr) return;
  ReadTexturesOf(*read, folder, place, context);
  Json whole = read->material;
  for (const auto& [key, member] : value.json.items()) {
    if (key == "file" || key == "material") continue;
    if (key == "model" && member != whole["model"]) {
      const JsonValue model{member, value.path.Member(key), value.faults};
      return model.AddFault(fmt::format("the document's material is of the model {}",
                                        whole["model"].get<std::string>()),
                            "leave \"model\" out");
    }
    whole[key] = member;
  }
  ReadMaterial({whole, value.path, value.faults}, context, material);
}

// Whether the members are those of a material of a MaterialX document: measured BRDFs have files,
// too.
bool IsOfDocument(const Json& json) {
  return json.is_object() && json.contains("file") &&
         !(json.contains("model") && json.at("model") == "measured");
}

// Reads everything but the name.
void ReadMaterial(const JsonValue& value, SceneContext* context, Material* material) {
  if (IsOfDocument(value.json)) {
    return ReadMaterialOfFile(value, context, material);
  }
  JsonObject object(value);
  std::vector<std::string_view> names;
  for (const MaterialModel& model : MaterialModels()) names.push_back(model.name);
  names.push_back(kSplit);

  object.Require("model", fmt::format("one of: {}", fmt::join(names, ", ")));
  size_t choice = 0;
  if (!object.Choice("model", names, &choice)) return;
  if (names[choice] == kSplit) {
    material->model = ReadSplit(&object, context);
  } else {
    const MaterialModel& model = MaterialModels()[choice];
    material->model = model.make().model;
    if (auto* measured = std::get_if<MeasuredMaterial>(&material->model)) {
      object.Require("file", "a .binary of the MERL database or a .bsdf of EPFL's");
      ReadMeasuredTable(&object, context, measured);
    }
    ReadParameters(model, &object, material);
    ReadMaps(model, &object, context, material);
  }
  object.RefuseOthers();
}

// The material with this name; if there is none, adds a fault.
MaterialId FindMaterial(const JsonValue& value, const SceneContext& context) {
  const auto name = value.json.get<std::string>();
  const auto found = context.read.names.find(name);
  if (found != context.read.names.end()) return found->second;
  if (!context.has_materials) return {};
  FaultUnknownKey(value, "material", name, context.read.names);
  return {};
}

constexpr std::string_view kReferenceHint = "the name of one in \"materials\", or an object";

}  // namespace

bool ReadParameterValue(const JsonValue& value, const MaterialParameter& parameter, Rgb* out) {
  if (parameter.is_color) return ReadColor(value, parameter.range, out);
  double number = 0;
  if (!ReadNumber(value, parameter.range, &number)) return false;
  *out = Rgb(number);
  return true;
}

void ReadMaterials(const JsonValue& value, SceneContext* context) {
  const JsonObject object(value, R"(materials by name: {"gold": {"model": ...}})");
  context->has_materials = object.is_object();
  if (!object.is_object()) return;
  // Registers all names first: a split may name a material that comes after it.
  std::vector<Material>& materials = context->scene->materials;
  for (const auto& [name, json] : value.json.items()) {
    context->read.names.try_emplace(name, MaterialId{static_cast<uint32_t>(materials.size())});
    materials.emplace_back().name = name;
  }
  uint32_t index = 0;
  for (const auto& [name, json] : value.json.items()) {
    const size_t before = value.faults->count();
    Material material =
        ReadNamedMaterial({json, value.path.Member(name), value.faults}, name, context);
    if (value.faults->count() != before) context->unreadable_materials.insert(index);
    materials[index++] = std::move(material);  // no reference is kept: reading adds inline
                                               // materials
  }
}

Material ReadNamedMaterial(const JsonValue& value, const std::string& name, SceneContext* context) {
  Material material;
  material.name = name;
  const auto user = context->user_brdfs->find(name);
  if (user != context->user_brdfs->end()) material.user = user->second;
  ReadMaterial(value, context, &material);
  return material;
}

void ChangeMaterial(const JsonValue& value, SceneContext* context, Material* material) {
  auto* const measured = std::get_if<MeasuredMaterial>(&material->model);
  if (value.json.is_object() &&
      (value.json.contains("model") || (measured == nullptr && value.json.contains("file")))) {
    *material = ReadNamedMaterial(value, std::string(material->name), context);
    return;
  }
  JsonObject object(value);
  if (measured != nullptr) ReadMeasuredTable(&object, context, measured);
  if (const MaterialModel* const model = ModelOf(*material)) {
    ReadParameters(*model, &object, material);
    ReadMaps(*model, &object, context, material);
  }
  object.RefuseOthers();
}

bool ReadMaterialId(const JsonValue& value, SceneContext* context, MaterialId* id) {
  if (value.json.is_string()) {
    *id = FindMaterial(value, *context);
    return id->valid();
  }
  if (!value.Expect(value.json.is_object(), "a material", kReferenceHint)) return false;
  Material material;
  material.name = value.path.ToString();
  ReadMaterial(value, context, &material);
  id->index = static_cast<uint32_t>(context->scene->materials.size());
  context->scene->materials.push_back(std::move(material));
  return true;
}

void ReadMaterialOf(JsonObject* shape, SceneContext* context, MaterialId* id) {
  const auto value = shape->Require("material", kReferenceHint);
  if (value) ReadMaterialId(*value, context, id);
}

void ReadMaterialList(const JsonValue& value, SceneContext* context, std::vector<MaterialId>* ids) {
  if (!value.Expect(value.json.is_array() && !value.json.empty(), "a list of materials")) return;
  for (size_t i = 0; i < value.json.size(); ++i) {
    ReadMaterialId(value.Element(i), context, &ids->emplace_back());
  }
}

bool ReadBaseMaterial(const JsonValue& value, SceneContext* context, Material* material) {
  if (value.json.is_string()) {
    const MaterialId id = FindMaterial(value, *context);
    if (!id.valid() || context->unreadable_materials.contains(id.index)) return false;
    const WholeMaterials* const whole = context->whole_materials;
    *material = whole != nullptr && whole->contains(id.index) ? whole->at(id.index)
                                                              : context->scene->materials[id.index];
    context->read.varied.insert(id.index);
    return true;
  }
  if (!value.Expect(value.json.is_object(), "a material", kReferenceHint)) return false;
  const size_t before = value.faults->count();
  ReadMaterial(value, context, material);
  return value.faults->count() == before;
}

}  // namespace nacre
