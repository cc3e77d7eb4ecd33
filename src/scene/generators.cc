// SPDX-License-Identifier: Apache-2.0
// scene/generators.cc: grids and rows of pairs. Clouds: cloud.cc.
#include "scene/generators.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "scene/limits.h"
#include "scene/material_parameters.h"

namespace nacre {
namespace {

[[noreturn]] void Refuse(std::string where, std::string what, std::string hint) {
  throw Error(ExitCode::kBadInput, std::move(where), std::move(what), std::move(hint));
}

// Returns the parameter that an axis varies, or nullptr if it varies none. Throws Error if the axis
// does not fit the material.
const MaterialParameter* CheckAxis(const GridAxis& axis, const Material& material,
                                   const std::string& where) {
  if (!limits::kGridCount.Contains(axis.count)) {
    Refuse(where, fmt::format("{} spheres along one axis", axis.count),
           Describe(limits::kGridCount));
  }
  if (axis.parameter.empty()) return nullptr;
  if (axis.values.size() != static_cast<size_t>(axis.count)) {
    Refuse(where, fmt::format("{} values for {} places", axis.values.size(), axis.count),
           "one value for each");
  }
  const MaterialModel* model = ModelOf(material);
  const MaterialParameter* parameter =
      model == nullptr ? nullptr : FindParameter(*model, axis.parameter);
  if (parameter == nullptr) {
    Refuse(where, fmt::format("the material has no parameter \"{}\"", axis.parameter),
           "name a parameter of the material's model; a split has none");
  }
  return parameter;
}

void CheckSizes(double spacing_x, double spacing_y, double radius, const std::string& where) {
  for (const double size : {spacing_x, spacing_y, radius}) {
    if (limits::kLength.Contains(size)) continue;
    Refuse(where, fmt::format("{} as a spacing or radius", size), Describe(limits::kLength));
  }
}

// "0.1" for a number or a grey, "0.9 0.6 0.2" for another colour: short enough for a label.
std::string Text(const MaterialParameter& parameter, const Rgb& value) {
  const bool grey = value.x == value.y && value.y == value.z;
  if (!parameter.is_color || grey) return fmt::format("{:.4g}", value.x);
  return fmt::format("{:.4g} {:.4g} {:.4g}", value.x, value.y, value.z);
}

std::string AxisLabel(const MaterialParameter& parameter, const GridAxis& axis, size_t i) {
  return axis.parameter + " " + Text(parameter, axis.values[i]);
}

// Sets the axis's parameter of `material` to its i-th value and says so in the name.
void Vary(const MaterialParameter* parameter, const GridAxis& axis, size_t i, Material* material) {
  if (parameter == nullptr) return;
  parameter->set(*material, axis.values[i]);
  material->name += " " + axis.parameter + "=" + Text(*parameter, axis.values[i]);
}

MaterialId AddMaterial(Material material, Scene* scene) {
  scene->materials.push_back(std::move(material));
  return {static_cast<uint32_t>(scene->materials.size() - 1)};
}

// The coordinate of place i of n that are centred on 0.
double Offset(size_t i, int n, double spacing) {
  return (static_cast<double>(i) - (n - 1) / 2.0) * spacing;
}

void AddGridLabels(const Grid& grid, const MaterialParameter* row_parameter,
                   const MaterialParameter* column_parameter, Scene* scene) {
  const double left = grid.center.x + Offset(0, grid.columns.count, grid.spacing.x) - grid.radius;
  const double top = grid.center.y - Offset(0, grid.rows.count, grid.spacing.y) + grid.radius;
  for (size_t i = 0; row_parameter != nullptr && i < grid.rows.values.size(); ++i) {
    const double y = grid.center.y - Offset(i, grid.rows.count, grid.spacing.y);
    scene->labels.push_back({AxisLabel(*row_parameter, grid.rows, i), Vec3d(left, y, grid.center.z),
                             Label::Side::kLeft});
  }
  for (size_t i = 0; column_parameter != nullptr && i < grid.columns.values.size(); ++i) {
    const double x = grid.center.x + Offset(i, grid.columns.count, grid.spacing.x);
    scene->labels.push_back({AxisLabel(*column_parameter, grid.columns, i),
                             Vec3d(x, top, grid.center.z), Label::Side::kAbove});
  }
}

void AddPairSphere(const PairRow& row, const PairSide& side, const MaterialParameter* parameter,
                   size_t i, const Vec3d& center, Scene* scene) {
  Material material = side.material;
  material.name = side.label.empty() ? "pair" : "pair " + side.label;
  Vary(parameter, side.values, i, &material);
  scene->spheres.push_back({center, row.radius, AddMaterial(std::move(material), scene)});
}

// Labels one side's spheres with their values, above or below them, and with the side's name at the
// left. `first` is the centre of the leftmost sphere.
void AddPairLabels(const PairRow& row, const PairSide& side, const MaterialParameter* parameter,
                   const Vec3d& first, Label::Side align, Scene* scene) {
  const Vec3d edge(0, align == Label::Side::kAbove ? row.radius : -row.radius, 0);
  for (size_t i = 0; parameter != nullptr && i < side.values.values.size(); ++i) {
    const Vec3d center = first + Vec3d(static_cast<double>(i) * row.pair_spacing, 0, 0);
    scene->labels.push_back({AxisLabel(*parameter, side.values, i), center + edge, align});
  }
  if (row.arrangement == PairRow::Arrangement::kStacked && !side.label.empty()) {
    scene->labels.push_back({side.label, first - Vec3d(row.radius, 0, 0), Label::Side::kLeft});
  }
}

}  // namespace

GridAxis LinearAxis(std::string parameter, const Rgb& from, const Rgb& to, int count) {
  GridAxis axis{count, std::move(parameter), {}};
  for (int i = 0; i < count; ++i) {
    const double t = count > 1 ? static_cast<double>(i) / (count - 1) : 0;
    axis.values.push_back(from * (1 - t) + to * t);  // exact at both ends
  }
  return axis;
}

GridAxis LogarithmicAxis(std::string parameter, const Rgb& from, const Rgb& to, int count) {
  GridAxis axis = LinearAxis(std::move(parameter), from, to, count);
  for (int i = 1; i + 1 < count; ++i) {  // the ends stay exact
    const double t = i / (count - 1.0);
    Rgb& value = axis.values[static_cast<size_t>(i)];
    for (int c = 0; c < 3; ++c) value[c] = from[c] * std::pow(to[c] / from[c], t);
  }
  return axis;
}

void AddGrid(const Grid& grid, Scene* scene) {
  const MaterialParameter* row_parameter = CheckAxis(grid.rows, grid.material, "grid rows");
  const MaterialParameter* column_parameter =
      CheckAxis(grid.columns, grid.material, "grid columns");
  CheckSizes(grid.spacing.x, grid.spacing.y, grid.radius, "grid");

  for (size_t row = 0; row < static_cast<size_t>(grid.rows.count); ++row) {
    for (size_t column = 0; column < static_cast<size_t>(grid.columns.count); ++column) {
      Material material = grid.material;
      material.name = "grid";
      Vary(row_parameter, grid.rows, row, &material);
      Vary(column_parameter, grid.columns, column, &material);
      const Vec3d offset(Offset(column, grid.columns.count, grid.spacing.x),
                         -Offset(row, grid.rows.count, grid.spacing.y), 0);
      scene->spheres.push_back(
          {grid.center + offset, grid.radius, AddMaterial(std::move(material), scene)});
    }
  }
  AddGridLabels(grid, row_parameter, column_parameter, scene);
}

void AddPair(const PairRow& row, Scene* scene) {
  const MaterialParameter* a_parameter = CheckAxis(row.a.values, row.a.material, "pair a");
  const MaterialParameter* b_parameter = CheckAxis(row.b.values, row.b.material, "pair b");
  CheckSizes(row.pair_spacing, row.spacing, row.radius, "pair");
  if (row.a.values.count != row.b.values.count) {
    Refuse("pair", fmt::format("{} values for a, {} for b", row.a.values.count, row.b.values.count),
           "as many for b as for a");
  }

  const bool stacked = row.arrangement == PairRow::Arrangement::kStacked;
  const Vec3d to_a = (stacked ? Vec3d(0, 1, 0) : Vec3d(-1, 0, 0)) * (row.spacing / 2);
  const auto middle = [&row](size_t i) {
    return row.center + Vec3d(Offset(i, row.a.values.count, row.pair_spacing), 0, 0);
  };
  for (size_t i = 0; i < static_cast<size_t>(row.a.values.count); ++i) {
    AddPairSphere(row, row.a, a_parameter, i, middle(i) + to_a, scene);
    AddPairSphere(row, row.b, b_parameter, i, middle(i) - to_a, scene);
  }
  AddPairLabels(row, row.a, a_parameter, middle(0) + to_a, Label::Side::kAbove, scene);
  AddPairLabels(row, row.b, b_parameter, middle(0) - to_a, Label::Side::kBelow, scene);
}

}  // namespace nacre
