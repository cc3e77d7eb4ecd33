// SPDX-License-Identifier: Apache-2.0
// cli/cmd_grid.cc: nacre grid: a sheet of spheres whose materials vary along two axes, without a
// scene file.
#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/render_job.h"
#include "cli/sheet.h"
#include "scene/material_parameters.h"
#include "scene_io/sheet_axis.h"

namespace nacre {
namespace {

using Kind = SheetAxis::Kind;

struct GridArguments {
  std::string rows, columns;  // empty: the default axes of the model
  std::string material = R"({"model": "metallic_roughness", "base_color": [0.9, 0.6, 0.2]})";
  SheetOptions sheet;
  RenderOptions options;
};

struct Axes {
  SheetAxis rows, columns;
  Json material;
  std::string material_label;
};

// Fills in axes that are not given with those of the model (MaterialModel::rows, columns), or of
// the first model if the other axis lists whole models. If the other axis varies the default
// parameter already, the model's other default axis is taken.
void CompleteAxes(const GridArguments& arguments, Axes* axes) {
  if (!arguments.rows.empty()) axes->rows = ParseSheetAxis("--rows", arguments.rows);
  if (!arguments.columns.empty()) axes->columns = ParseSheetAxis("--columns", arguments.columns);
  const Json* base = &axes->material;
  for (const SheetAxis* axis : {&axes->rows, &axes->columns}) {
    if (axis->kind == Kind::kMaterial && !axis->values.empty()) base = &axis->values.front();
  }
  const auto name = base->find("model");
  const MaterialModel* model =
      name != base->end() && name->is_string() ? FindModel(name->get<std::string>()) : nullptr;
  // For a model that does not exist, the check of the axes reports the error.
  if (model == nullptr) model = FindModel("metallic_roughness");
  const auto own = [&](std::string_view first, std::string_view second, const SheetAxis& other) {
    const SheetAxis axis = ParseSheetAxis("--material", std::string(first));
    return axis.name == other.name ? ParseSheetAxis("--material", std::string(second)) : axis;
  };
  if (arguments.rows.empty()) axes->rows = own(model->rows, model->columns, axes->columns);
  if (arguments.columns.empty()) axes->columns = own(model->columns, model->rows, axes->rows);
}

Axes ParseAxes(const GridArguments& arguments) {
  Axes axes;
  axes.material = ParseMaterialText("--material", arguments.material);
  CompleteAxes(arguments, &axes);
  axes.material_label = MaterialLabel(axes.material);
  axes.material.erase("name");
  if (axes.rows.name == axes.columns.name) {
    throw Error(ExitCode::kUsage, "--columns",
                fmt::format("rows and columns both vary {}", axes.rows.name),
                "name another parameter");
  }
  std::vector<Json> bases = {axes.material};
  std::string of = "--material";
  for (const SheetAxis* axis : {&axes.rows, &axes.columns}) {
    if (axis->kind != Kind::kMaterial) continue;
    bases = axis->values;
    of = axis == &axes.rows ? "--rows" : "--columns";
  }
  CheckModels(of, bases);
  CheckSheetAxis("--rows", bases, &axes.rows);
  CheckSheetAxis("--columns", bases, &axes.columns);
  return axes;
}

// The axis in the form of the scene format's "grid".
Json GridAxisJson(const SheetAxis& axis) {
  if (axis.kind == Kind::kParameter) return {{"parameter", axis.name}, {"values", axis.values}};
  return {{"count", 1}};
}

// Sets value i of an axis that a "grid" of the scene format cannot vary in the base material.
void ApplyPlace(const SheetAxis& axis, size_t i, Json* material) {
  if (axis.kind == Kind::kMaterial) *material = axis.values[i];
  if (axis.kind == Kind::kChoice) (*material)[axis.name] = axis.values[i];
}

size_t PlacesOf(const SheetAxis& axis) {
  return axis.kind == Kind::kParameter ? 1 : axis.values.size();
}

// A parameter varies within a grid shape; each choice or whole material gets a grid shape of its
// own.
Json GridShapes(const Axes& axes) {
  const size_t row_places = PlacesOf(axes.rows);
  const size_t column_places = PlacesOf(axes.columns);
  const bool material_first = axes.rows.kind == Kind::kMaterial;
  Json shapes = Json::array();
  for (size_t row = 0; row < row_places; ++row) {
    for (size_t column = 0; column < column_places; ++column) {
      Json material = axes.material;
      if (material_first) ApplyPlace(axes.rows, row, &material);
      ApplyPlace(axes.columns, column, &material);
      if (!material_first) ApplyPlace(axes.rows, row, &material);
      const double x = static_cast<double>(column) - (static_cast<double>(column_places) - 1) / 2;
      const double y = (static_cast<double>(row_places) - 1) / 2 - static_cast<double>(row);
      shapes.push_back({{"type", "grid"},
                        {"center", {x, y, 0}},
                        {"radius", kSheetSphereRadius},
                        {"material", material},
                        {"rows", GridAxisJson(axes.rows)},
                        {"columns", GridAxisJson(axes.columns)}});
    }
  }
  return shapes;
}

// Lists the parameters of the base material that no axis varies: "base_color 0.9 0.6 0.2".
std::string FixedParameters(const Axes& axes) {
  std::vector<std::string> parts;
  for (const auto& [key, value] : axes.material.items()) {
    if (key == "model" || key == axes.rows.name || key == axes.columns.name) continue;
    std::string text = value.is_string() ? value.get<std::string>() : JsonText(value);
    std::erase_if(text, [](char c) { return c == '[' || c == ']'; });
    for (char& c : text) c = c == ',' ? ' ' : c;
    parts.push_back(key + " " + text);
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

SheetText MakeText(const Axes& axes, const SheetOptions& sheet, const Lighting& lighting) {
  const bool has_base = axes.rows.kind != Kind::kMaterial && axes.columns.kind != Kind::kMaterial;
  SheetText text;
  text.title =
      SheetTitle(sheet, fmt::format("{}{} by {}", has_base ? axes.material_label + ": " : "",
                                    axes.rows.name, axes.columns.name));
  text.row_name = axes.rows.name;
  text.row_labels = axes.rows.labels;
  text.column_name = axes.columns.name;
  text.column_labels = axes.columns.labels;
  const std::string fixed = has_base ? FixedParameters(axes) : "";
  text.footer = {fixed + (fixed.empty() ? "" : "; ") + "light: " + lighting.label};
  return text;
}

void RunGrid(const GridArguments& arguments) {
  const RenderOptions& options = arguments.options;
  const Axes axes = ParseAxes(arguments);
  const auto rows = static_cast<int>(axes.rows.values.size());
  const auto columns = static_cast<int>(axes.columns.values.size());
  const Lighting lighting = MakeLighting(arguments.sheet.lighting, std::max(rows, columns) / 2.0);
  const SheetRequest request = MakeSheetRequest(arguments.sheet, options, lighting, rows, columns);
  const SheetText text = options.labels ? MakeText(axes, arguments.sheet, lighting) : SheetText{};
  const SheetPage page = LayOutSheet(text, request);
  const std::string scene = SheetScene(GridShapes(axes), Json::object(), request, page, lighting);
  RunRenderJob(
      options, InputFiles(arguments.sheet.lighting),
      [&](const LoadOptions& load) {
        return LoadSheet(scene, "nacre grid", arguments.sheet, page, load);
      },
      page.text);
}

// Lists the default axes of the models: "roughness=0.1:0.9:5 (metallic_roughness, conductor); ...".
std::string ModelAxes(std::string_view MaterialModel::*axis) {
  std::vector<std::pair<std::string_view, std::string>> axes;
  for (const MaterialModel& model : MaterialModels()) {
    const auto found = std::find_if(axes.begin(), axes.end(),
                                    [&](const auto& known) { return known.first == model.*axis; });
    if (found == axes.end()) {
      axes.emplace_back(model.*axis, model.name);
    } else {
      found->second += fmt::format(", {}", model.name);
    }
  }
  std::string text;
  for (const auto& [name, models] : axes) {
    text += fmt::format("{}{} ({})", text.empty() ? "" : "; ", name, models);
  }
  return text;
}

constexpr char kAxisHelp[] =
    "Parameter that varies {}: PARAMETER=FROM:TO:COUNT (both ends included; :log for equal ratios) "
    "or PARAMETER=A,B,C. A parameter is a number, a colour (#rrggbb or [r,g,b], mixed in linear "
    "light), a choice (shadowing=height_correlated,separable) or material, for whole models by "
    "name or as JSON";

}  // namespace

void AddGridCommand(CLI::App* app, int*) {
  CLI::App* command =
      app->add_subcommand("grid", "Render a sheet of spheres over two parameters of a material");
  const auto arguments = std::make_shared<GridArguments>();
  command
      ->add_option("--rows", arguments->rows,
                   fmt::format(kAxisHelp, "downwards") +
                       ". Default by model: " + ModelAxes(&MaterialModel::rows))
      ->type_name("AXIS");
  command
      ->add_option("--columns", arguments->columns,
                   fmt::format(kAxisHelp, "to the right") +
                       ". Default by model: " + ModelAxes(&MaterialModel::columns))
      ->type_name("AXIS");
  command
      ->add_option("--material", arguments->material,
                   "Material whose parameters vary: a model's name, a material as JSON, or a "
                   "MaterialX document, FILE.mtlx or FILE.mtlx#NAME")
      ->capture_default_str();
  AddSheetOptions(command, &arguments->sheet, &arguments->options);
  command->footer(
      "1 to 64 spheres along each axis. Without --size the picture is as large as the sheet "
      "needs.\n"
      "Examples:\n"
      "  nacre grid -o grid.png\n"
      "  nacre grid --material phong -o phong.png\n"
      "  nacre grid --material blinn_phong --rows shininess=8,32,128 --columns kd=0:0.8:5 "
      "-o kd.png\n"
      "  nacre grid --material conductor --rows preset=gold,copper,silver \\\n"
      "    --columns roughness=0,0.1,0.3,0.6 --light studio --background '#ffffff' -o metals.png\n"
      "  nacre grid --columns material=phong,blinn_phong,modified_phong \\\n"
      "    --rows shininess=4,16,64,256 -o exponents.png\n"
      "  nacre grid --rows base_color=#c03020:#2040c0:3 --columns roughness=0.1:1:6 \\\n"
      "    --light sky --sphere-size 160 -o colours.png\n"
      "  nacre grid --rows compensation=turquin,kulla_conty,none --columns roughness=0:1:6 \\\n"
      "    --material '{\"model\": \"metallic_roughness\", \"base_color\": 1, \"metallic\": 1}' "
      "\\\n"
      "    --light furnace -o energy.png");
  command->callback([arguments] { RunGrid(*arguments); });
}

}  // namespace nacre
