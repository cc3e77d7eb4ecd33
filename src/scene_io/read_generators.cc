// SPDX-License-Identifier: Apache-2.0
// scene_io/read_generators.cc: the shapes "grid", "pair" and "cloud".
#include <array>
#include <utility>

#include "scene/generators.h"
#include "scene/material_parameters.h"
#include "scene_io/readers.h"

namespace nacre {
namespace {

// Reads a value of `parameter`; a number becomes three equal components.
bool ReadParameterValue(const JsonValue& value, const MaterialParameter& parameter, Rgb* out) {
  if (parameter.is_color) return ReadColor(value, parameter.range, out);
  double number = 0;
  if (!ReadNumber(value, parameter.range, &number)) return false;
  *out = Rgb(number, number, number);
  return true;
}

// The parameter that the member "parameter" names, or nullptr. `material` is the material that it
// varies; nullptr if that has faults itself.
const MaterialParameter* ReadParameter(JsonObject* object, const Material* material) {
  std::string name;
  if (!object->Text("parameter", &name) || material == nullptr) return nullptr;
  const MaterialModel* const model = ModelOf(*material);
  const MaterialParameter* const parameter =
      model == nullptr ? nullptr : FindParameter(*model, name);
  if (parameter != nullptr) return parameter;
  std::vector<std::string> names;
  if (model != nullptr) {
    for (const MaterialParameter& known : model->parameters) names.emplace_back(known.name);
  }
  const JsonPath path = object->path().Member("parameter");
  FaultUnknownName({*object->Find("parameter"), path, object->faults()}, "parameter", name, names);
  return nullptr;
}

void ReadValues(const JsonValue& value, const MaterialParameter& parameter, GridAxis* axis) {
  if (!value.Expect(value.json.is_array() && !value.json.empty(), "a list of values")) return;
  axis->count = static_cast<int>(value.json.size());
  for (size_t i = 0; i < value.json.size(); ++i) {
    ReadParameterValue({value.json[i], value.path.Element(i), value.faults}, parameter,
                       &axis->values.emplace_back());
  }
}

void ReadEnds(JsonObject* object, const MaterialParameter& parameter, GridAxis* axis) {
  const Json* const from = object->Require("from", "the first value");
  const Json* const to = object->Require("to", "the last value");
  if (from == nullptr || to == nullptr) return;
  Rgb first;
  Rgb last;
  const JsonPath from_path = object->path().Member("from");
  const JsonPath to_path = object->path().Member("to");
  const bool has_from = ReadParameterValue({*from, from_path, object->faults()}, parameter, &first);
  const bool has_to = ReadParameterValue({*to, to_path, object->faults()}, parameter, &last);
  if (has_from && has_to) *axis = LinearAxis(axis->parameter, first, last, axis->count);
}

// Reads the members parameter and values; or parameter, from, to and count; or count alone.
void ReadAxis(JsonObject* object, const Material* material, GridAxis* axis) {
  const MaterialParameter* const parameter = ReadParameter(object, material);
  const Json* const values = object->Find("values");
  const Json* const from = object->Find("from");
  const Json* const to = object->Find("to");
  const bool has_ends = from != nullptr || to != nullptr;
  const bool has_count = object->Find("count") != nullptr;
  object->Whole("count", limits::kGridCount, &axis->count);
  if (values == nullptr) {
    object->Require("count", "how many spheres; or give \"values\"");
  } else if (has_ends || has_count) {
    object->value().AddFault("\"values\" take the place of \"from\", \"to\" and \"count\"",
                             "keep one or the other");
  }
  if (object->Find("parameter") == nullptr && (values != nullptr || has_ends)) {
    object->Require("parameter", "what the values are of");
  }
  if (parameter == nullptr) return;
  axis->parameter = parameter->name;
  if (values != nullptr) {
    ReadValues({*values, object->path().Member("values"), object->faults()}, *parameter, axis);
  } else {
    ReadEnds(object, *parameter, axis);
  }
}

void ReadGridAxis(JsonObject* shape, std::string_view name, const Material* material,
                  GridAxis* axis) {
  const Json* const json = shape->Find(name);
  if (json == nullptr) return;
  JsonObject object({*json, shape->path().Member(name), shape->faults()},
                    R"({"parameter": "roughness", "from": 0.1, "to": 0.9, "count": 5})");
  ReadAxis(&object, material, axis);
  object.RefuseOthers();
}

// Reads the required member "material", which the axes vary. Returns `material`, or nullptr if it
// has faults.
const Material* ReadBase(JsonObject* object, SceneContext* context, Material* material) {
  const Json* const json = object->Require("material", "what the axes vary");
  if (json == nullptr) return nullptr;
  const JsonPath path = object->path().Member("material");
  const bool is_read = ReadBaseMaterial({*json, path, object->faults()}, context, material);
  return is_read ? material : nullptr;
}

// Reads one number for both directions, or [x, y].
void ReadSpacing(const JsonValue& value, Vec2d* spacing) {
  if (value.json.is_number()) {
    double both = 1;
    if (ReadNumber(value, limits::kLength, &both)) *spacing = Vec2d(both, both);
    return;
  }
  if (!value.Expect(value.json.is_array() && value.json.size() == 2, "[x, y] or one number"))
    return;
  ReadNumber({value.json[0], value.path.Element(0), value.faults}, limits::kLength, &spacing->x);
  ReadNumber({value.json[1], value.path.Element(1), value.faults}, limits::kLength, &spacing->y);
}

void ReadPairSide(JsonObject* shape, std::string_view name, SceneContext* context, PairSide* side) {
  const Json* const json = shape->Require(name, "one side of the pairs");
  if (json == nullptr) return;
  JsonObject object({*json, shape->path().Member(name), shape->faults()},
                    R"({"material": ..., "parameter": "roughness", "values": [0.2, 0.5]})");
  const Material* const base = ReadBase(&object, context, &side->material);
  side->label = side->material.name;  // empty for an inline one
  object.Text("label", &side->label);
  ReadAxis(&object, base, &side->values);
  object.RefuseOthers();
}

// Reads one number, or [smallest, largest].
void ReadRadii(const JsonValue& value, Cloud* cloud) {
  if (value.json.is_number()) {
    if (ReadNumber(value, limits::kLength, &cloud->radius_min)) {
      cloud->radius_max = cloud->radius_min;
    }
    return;
  }
  if (!value.Expect(value.json.is_array() && value.json.size() == 2,
                    "[smallest, largest] or one number")) {
    return;
  }
  ReadNumber({value.json[0], value.path.Element(0), value.faults}, limits::kLength,
             &cloud->radius_min);
  ReadNumber({value.json[1], value.path.Element(1), value.faults}, limits::kLength,
             &cloud->radius_max);
}

}  // namespace

void ReadGrid(JsonObject* shape, SceneContext* context) {
  Grid grid;
  shape->Point("center", &grid.center);
  if (const Json* spacing = shape->Find("spacing")) {
    ReadSpacing({*spacing, shape->path().Member("spacing"), shape->faults()}, &grid.spacing);
  }
  shape->Number("radius", limits::kLength, &grid.radius);
  const Material* const base = ReadBase(shape, context, &grid.material);
  ReadGridAxis(shape, "rows", base, &grid.rows);
  ReadGridAxis(shape, "columns", base, &grid.columns);
  if (shape->faults()->count() != 0) return;
  context->budget->Spend(SceneBudget::kWithMaterial * static_cast<uint64_t>(grid.rows.count) *
                         static_cast<uint64_t>(grid.columns.count));
  AddGrid(grid, context->scene);
}

void ReadPair(JsonObject* shape, SceneContext* context) {
  constexpr std::array<std::string_view, 2> kArrangements = {"stacked", "side_by_side"};
  PairRow row;
  size_t arrangement = 0;
  shape->Choice("arrangement", kArrangements, &arrangement);
  row.arrangement = static_cast<PairRow::Arrangement>(arrangement);
  shape->Point("center", &row.center);
  shape->Number("pair_spacing", limits::kLength, &row.pair_spacing);
  shape->Number("spacing", limits::kLength, &row.spacing);
  shape->Number("radius", limits::kLength, &row.radius);
  ReadPairSide(shape, "a", context, &row.a);
  ReadPairSide(shape, "b", context, &row.b);
  if (shape->faults()->count() != 0) return;
  context->budget->Spend(2 * SceneBudget::kWithMaterial *
                         static_cast<uint64_t>(row.a.values.count));
  AddPair(row, context->scene);
}

void ReadCloud(JsonObject* shape, SceneContext* context) {
  Cloud cloud;
  shape->Require("count", "how many spheres");
  shape->Whole("count", limits::kCloudCount, &cloud.count);
  shape->Whole("seed", limits::kSeed, &cloud.seed);
  shape->Require("min", "the corner of the box with the smallest coordinates");
  shape->Point("min", &cloud.min);
  shape->Require("max", "the corner of the box with the largest coordinates");
  shape->Point("max", &cloud.max);
  if (const Json* radius = shape->Require("radius", "[smallest, largest] or one number")) {
    ReadRadii({*radius, shape->path().Member("radius"), shape->faults()}, &cloud);
  }
  if (const Json* materials = shape->Require("materials", "a list to choose from")) {
    ReadMaterialList({*materials, shape->path().Member("materials"), shape->faults()}, context,
                     &cloud.materials);
  }
  if (shape->faults()->count() != 0) return;
  context->budget->Spend(cloud.count);
  AddCloud(cloud, context->threads, context->scene);
}

}  // namespace nacre
