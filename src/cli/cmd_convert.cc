// SPDX-License-Identifier: Apache-2.0
// cli/cmd_convert.cc: nacre convert: converts a material to the nearest one of another model.
#include <cmath>
#include <memory>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/commands.h"
#include "cli/difference_page.h"
#include "cli/given_material.h"
#include "cli/outputs.h"
#include "cli/print.h"
#include "cli/usage_error.h"
#include "image_io/output_file.h"
#include "scene_io/load_scene.h"
#include "scene_io/scene_json.h"
#include "scene_io/sheet_axis.h"
#include "shading/material_fit.h"
#include "study/material_curves.h"

namespace nacre {
namespace {

struct ConvertArguments {
  std::string material;
  std::string to = "metallic_roughness";
  std::vector<std::string> curves;  // paths
  bool json = false;
  SheetOptions sheet;
  RenderOptions options;
};

Json ResidualJson(const MaterialResidual& residual) {
  Json views = Json::array();
  for (const LobeResidual& view : residual.views) {
    views.push_back({{"view_deg", view.view_deg},
                     {"rms", view.rms},
                     {"peak", view.peak},
                     {"width", view.width},
                     {"albedo", view.albedo}});
  }
  return {{"rms", residual.rms}, {"views", views}};
}

// "-" if there is no lobe to compare with.
std::string RmsText(double rms) { return std::isinf(rms) ? "-" : fmt::format("{:.3f}", rms); }

std::string Table(const MaterialFit& fit) {
  std::string text =
      "                closed form                        fit\n"
      "view  lobe rms    peak   width  albedo  lobe rms    peak   width  albedo\n";
  const auto row = [](const LobeResidual& r) {
    return fmt::format("{:>9} {:>+7.3f} {:>+7.3f} {:>7.4f}", RmsText(r.rms), r.peak, r.width,
                       r.albedo);
  };
  for (size_t i = 0; i < fit.residual.views.size(); ++i) {
    text += fmt::format("{:>3.0f}  {} {}\n", fit.residual.views[i].view_deg,
                        row(fit.guess_residual.views[i]), row(fit.residual.views[i]));
  }
  text += fmt::format("all  {:>9}                         {:>9}\n", RmsText(fit.guess_residual.rms),
                      RmsText(fit.residual.rms));
  text +=
      "lobe rms: of the difference of BRDF n.l over all directions of light, over the original's,\n"
      "  - where that has no lobe; all: where a sphere shows the highlights of lights in front of "
      "it\n"
      "peak, width: of the highlight in the plane of incidence (the width at half its peak), "
      "relative;\n"
      "albedo: of lobe and base, the worst channel\n";
  if (fit.log_rms >= 0) {
    text += fmt::format(
        "log rms {:>9.4f} {:>29.4f}\n"
        "log rms: of the difference of log(1 + BRDF n.l), which is what was fitted (Low et al. "
        "2012)\n",
        fit.guess_log_rms, fit.log_rms);
  }
  for (const std::string& note : fit.notes) text += "not kept: " + note + "\n";
  return text;
}

// Refuses options that only affect a picture if none is drawn.
void RefuseWhatCannotApply(const ConvertArguments& arguments, const CLI::App& command) {
  if (!arguments.options.outputs.empty()) {
    RefuseWhatNoDifferencePageTakes(command, "nacre convert");
    return;
  }
  static const std::set<std::string> kApplying = {"MATERIAL", "--to",    "--curves",
                                                  "--json",   "--quiet", "--target"};
  RefuseOptions(
      command, [](const CLI::Option& option) { return kApplying.contains(option.get_name()); },
      "nacre convert without a picture", "-o FILE.png draws original, conversion and difference");
}

void DrawCurves(const ConvertArguments& arguments, const Material& original,
                const std::string& label, const MaterialFit& fit) {
  if (arguments.curves.empty()) return;
  const Figure figure = LobeFigure({{label, original},
                                    {arguments.to + ", closed form", fit.guess},
                                    {arguments.to + ", fit", fit.fitted}});
  for (const std::string& path : arguments.curves) WriteFigure(path, figure);
}

// The paths of all files that are to be written; checks those of curves.
std::vector<std::string> CheckFiles(const ConvertArguments& arguments) {
  std::vector<std::string> paths = arguments.options.outputs;
  for (const std::string& path : arguments.curves) {
    CheckFigurePath(path);
    CheckWritable(path);
    paths.push_back(path);
  }
  CheckPathsDiffer(paths);
  return paths;
}

// Draws the page with both materials and their difference, and returns their measures; null if no
// page was asked for.
Json DrawPage(const ConvertArguments& arguments, const Json& source, const std::string& label,
              const Material& original, const MaterialFit& fit,
              const std::vector<std::string>& outputs) {
  if (arguments.options.outputs.empty()) return {};
  const Json fitted = MaterialJson(fit.fitted);
  DifferencePage page{source, fitted, label, arguments.to, {}, {}};
  page.title = SheetTitle(arguments.sheet, fmt::format("{} as {}", label, arguments.to));
  page.footer = {"A  " + DescribeMaterial(MaterialJson(original)), "B  " + DescribeMaterial(fitted),
                 fmt::format("lobe rms {} (closed form {}); light: {}", RmsText(fit.residual.rms),
                             RmsText(fit.guess_residual.rms),
                             MakeLighting(arguments.sheet.lighting, 0.5).label)};
  return DrawDifference(page, arguments.sheet, arguments.options, "nacre convert", outputs)
      .ToJson();
}

void RunConvert(const ConvertArguments& arguments, const CLI::App& command) {
  RefuseWhatCannotApply(arguments, command);
  const std::vector<std::string> outputs = CheckFiles(arguments);
  Json source = ParseMaterialText("MATERIAL", arguments.material);
  const std::string label = MaterialLabel(source);
  source.erase("name");
  LoadOptions options = OptionsForGiven(source);
  if (!outputs.empty()) options.on_warning = nullptr;  // the page's scene will tell
  const Material original = LoadMaterialText(JsonText(source), "MATERIAL", options);
  const MaterialFit fit = FitMaterial(original, arguments.to);
  const Json difference = DrawPage(arguments, source, label, original, fit, outputs);
  DrawCurves(arguments, original, label, fit);
  const Json fitted = MaterialJson(fit.fitted);
  if (!arguments.json) {
    PrintOut(JsonText(fitted) + "\n" + (arguments.options.quiet ? "" : Table(fit)));
    return;
  }
  Json json = {
      {"original", MaterialJson(original)},
      {"material", fitted},
      {"residual", ResidualJson(fit.residual)},
      {"closed_form",
       {{"material", MaterialJson(fit.guess)}, {"residual", ResidualJson(fit.guess_residual)}}},
      {"not_kept", fit.notes}};
  if (fit.log_rms >= 0) {
    json["residual"]["log_rms"] = fit.log_rms;
    json["closed_form"]["residual"]["log_rms"] = fit.guess_log_rms;
  }
  if (!difference.is_null()) json["picture"] = difference;
  PrintOut(JsonText(json, 2) + "\n");
}

}  // namespace

void AddConvertCommand(CLI::App* app, int*) {
  CLI::App* command = app->add_subcommand(
      "convert", "Find the nearest material of another model, Phong to PBR and back");
  const auto arguments = std::make_shared<ConvertArguments>();
  command
      ->add_option("MATERIAL", arguments->material,
                   "A model's name, a material as JSON, or FILE.mtlx#NAME of a MaterialX document")
      ->required();
  std::vector<std::string> targets(FitTargets().begin(), FitTargets().end());
  command
      ->add_option("--to", arguments->to,
                   fmt::format("Model to convert to: {}", fmt::join(targets, ", ")))
      ->check(CLI::IsMember(targets))
      ->capture_default_str();
  command
      ->add_option("--curves", arguments->curves,
                   "Draw the lobes of original, closed form and fit over the light's angle, as "
                   ".svg, .png or .csv; repeatable")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command->add_flag("--json", arguments->json,
                    "Print materials, residuals and what the model cannot express as JSON");
  AddSheetOptions(command, &arguments->sheet, &arguments->options);
  command->get_option("--output")->required(false);
  command->footer(
      "Prints the material for a scene file, and how far it is from the original: by the closed\n"
      "forms (n = 2 / alpha^2 - 2 for Blinn's lobe, a fourth of it for Phong's) and after the "
      "fit.\n"
      "-o FILE.png draws original, conversion and difference, --curves FILE.svg their lobes.\n"
      "Examples:\n"
      "  nacre convert '{\"model\": \"phong\", \"kd\": [0.6,0.1,0.1], \"ks\": 0.04, "
      "\"shininess\": 50}'\n"
      "  nacre convert '{\"model\": \"metallic_roughness\", \"base_color\": [1,0.77,0.34], "
      "\"metallic\": 1}' \\\n"
      "    --to blinn_phong -o gold.png --light studio --curves gold.svg");
  command->callback([arguments, command] { RunConvert(*arguments, *command); });
}

}  // namespace nacre
