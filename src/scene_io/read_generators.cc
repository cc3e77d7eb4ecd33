// SPDX-License-Identifier: Apache-2.0
// scene_io/read_generators.cc: the shapes "grid", "pair" and "cloud".
#include <array>

#include "base/error.h"
#include "scene/generators.h"
#include "scene/material_parameters.h"
#include "scene_io/readers.h"

namespace nacre {
namespace {

// The parameter that the member "parameter" names, or nullptr. `material` is the material that it
// varies; nullptr if that has faults itself.
const MaterialParameter* ReadParameter(JsonObject* object, const Material* material) {
  std::string name;
  if (!object->Text("parameter", &name) || material == nullptr) return nullptr;
  const MaterialModel* const model = ModelOf(*material);
  const MaterialParameter* const parameter =
      model == nullptr ? nullptr : FindParameter(*model, name);
  if (parameter != nullptr) return parameter;
  FaultUnknownName(*object->Find("parameter"), "parameter", name,
                   model == nullptr ? std::vector<std::string>() : NamesOf(model->parameters));
  return nullptr;
}

void ReadValues(const JsonValue& value, const MaterialParameter& parameter, GridAxis* axis) {
  if (!value.Expect(value.json.is_array() && !value.json.empty(), "a list of values")) return;
  axis->count = static_cast<int>(value.json.size());
  for (size_t i = 0; i < value.json.size(); ++i) {
    ReadParameterValue(value.Element(i), parameter, &axis->values.emplace_back());
  }
}

void ReadEnds(JsonObject* object, const MaterialParameter& parameter, GridAxis* axis) {
  const auto from = object->Require("from", "the first value");
  const auto to = object->Require("to", "the last value");
  if (!from || !to) return;
  Rgb first;
  Rgb last;
  const bool has_from = ReadParameterValue(*from, parameter, &first);
  const bool has_to = ReadParameterValue(*to, parameter, &last);
  if (has_from && has_to) *axis = LinearAxis(axis->parameter, first, last, axis->count);
}

// Reads the members parameter and values; or parameter, from, to and count; or count alone.
void ReadAxis(JsonObject* object, const Material* material, GridAxis* axis) {
  const MaterialParameter* const parameter = ReadParameter(object, material);
  const auto values = object->Find("values");
  const bool has_from = object->Find("from").has_value();
  const bool has_ends = object->Find("to").has_value() || has_from;
  const bool has_count = object->Find("count").has_value();
  object->Whole("count", limits::kGridCount, &axis->count);
  if (!values) {
    object->Require("count", "how many spheres; or give \"values\"");
  } else if (has_ends || has_count) {
    object->value().AddFault("\"values\" take the place of \"from\", \"to\" and \"count\"",
                             "keep one or the other");
  }
  if (!object->Find("parameter") && (values || has_ends)) {
    object->Require("parameter", "what the values are of");
  }
  if (parameter == nullptr) return;
  axis->parameter = parameter->name;
  if (values) {
    ReadValues(*values, *parameter, axis);
  } else {
    ReadEnds(object, *parameter, axis);
  }
}

void ReadGridAxis(JsonObject* shape, std::string_view name, const Material* material,
                  GridAxis* axis) {
  const auto value = shape->Find(name);
  if (!value) return;
  JsonObject object(*value, R"({"parameter": "roughness", "from": 0.1, "to": 0.9, "count": 5})");
  ReadAxis(&object, material, axis);
  object.RefuseOthers();
}

// Reads the required member "material", which the axes vary. Returns `material`, or nullptr if it
// has faults.
const Material* ReadBase(JsonObject* object, SceneContext* context, Material* material) {
  const auto value = object->Require("material", "what the axes vary");
  return value && ReadBaseMaterial(*value, context, material) ? material : nullptr;
}

void ReadPairSide(JsonObject* shape, std::string_view name, SceneContext* context, PairSide* side) {
  const auto value = shape->Require(name, "one side of the pairs");
  if (!value) return;
  JsonObject object(*value, R"({"material": ..., "parameter": "roughness", "values": [0.2, 0.5]})");
  const Material* const base = ReadBase(&object, context, &side->material);
  side->label = side->material.name;  // empty for an inline one
  object.Text("label", &side->label);
  ReadAxis(&object, base, &side->values);
  object.RefuseOthers();
}

}  // namespace

void ReadGrid(JsonObject* shape, SceneContext* context) {
  Grid grid;
  shape->Point("center", &grid.center);
  if (const auto spacing = shape->Find("spacing")) {
    ReadTwoNumbers(*spacing, limits::kLength, "[x, y] or one number", &grid.spacing.x,
                   &grid.spacing.y);
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
  shape->Choice("arrangement", kArrangements, &row.arrangement);
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
  constexpr std::string_view kRadii = "[smallest, largest] or one number";
  if (const auto radius = shape->Require("radius", kRadii)) {
    ReadTwoNumbers(*radius, limits::kLength, kRadii, &cloud.radius_min, &cloud.radius_max);
  }
  if (const auto materials = shape->Require("materials", "a list to choose from")) {
    ReadMaterialList(*materials, context, &cloud.materials);
  }
  if (shape->faults()->count() != 0) return;
  context->budget->Spend(cloud.count);
  AddCloud(cloud, context->threads, context->scene);
}

}  // namespace nacre
