// SPDX-License-Identifier: Apache-2.0
// cli/cmd_pair.cc: nacre pair: two materials as halves of one sphere, side by side, or with their
// difference.
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/difference_page.h"
#include "cli/given_material.h"
#include "cli/print.h"
#include "cli/render_job.h"
#include "scene_io/load_scene.h"
#include "scene_io/scene_json.h"
#include "scene_io/sheet_axis.h"

namespace nacre {
namespace {

struct PairArguments {
  // Both are the same red plastic: shininess 2 / alpha^2 - 2 for roughness 0.4, ks = F0.
  std::string a = R"({"model": "phong", "color": [0.8, 0.2, 0.2], "kd": 0.96, "ks": 0.04, )"
                  R"("ka": 0.96, "shininess": 19})";
  std::string b = R"({"model": "metallic_roughness", "base_color": [0.8, 0.2, 0.2], )"
                  R"("roughness": 0.4})";
  std::string layout = "split";
  bool json = false;
  SheetOptions sheet;
  RenderOptions options;
};

struct Side {
  Json json;      // as given
  Json complete;  // with all parameters
  std::string label;
};

Side ReadSide(const std::string& option, const std::string& text) {
  Side side;
  side.json = ParseMaterialText(option, text);
  side.label = MaterialLabel(side.json);
  side.json.erase("name");
  LoadOptions options = OptionsForGiven(side.json);
  options.on_warning = nullptr;  // the sheet's scene, which has the material, too, will tell
  const Material material = LoadMaterialText(JsonText(side.json), option, options);
  if (std::holds_alternative<SplitMaterial>(material.model)) {
    throw Error(ExitCode::kBadInput, option, "a split is not one material", "give --a and --b");
  }
  side.complete = MaterialJson(material);
  return side;
}

std::string Title(const PairArguments& arguments, const Side& a, const Side& b) {
  return SheetTitle(arguments.sheet, fmt::format("{} and {}", a.label, b.label));
}

std::vector<std::string> Footer(const PairArguments& arguments, const Side& a, const Side& b) {
  return {"A  " + DescribeMaterial(a.complete), "B  " + DescribeMaterial(b.complete),
          "light: " + MakeLighting(arguments.sheet.lighting, 0.5).label};
}

// Renders both materials on one page through the job that all rendering commands share.
void RenderBoth(const PairArguments& arguments, const Side& a, const Side& b) {
  const RenderOptions& options = arguments.options;
  const bool split = arguments.layout == "split";
  const Lighting lighting = MakeLighting(arguments.sheet.lighting, split ? 0.5 : 1, split);
  const SheetRequest request =
      MakeSheetRequest(arguments.sheet, options, lighting, 1, split ? 1 : 2);
  SheetText text;
  if (options.labels) {
    text.title = Title(arguments, a, b);
    text.footer = Footer(arguments, a, b);
    text.column_labels = {"A | B"};
    if (!split) text.column_labels = {"A: " + a.label, "B: " + b.label};
  }
  const SheetPage page = LayOutSheet(text, request);
  Json materials = {{"a", a.json}, {"b", b.json}};
  Json shapes = Json::array();
  if (split) {
    const double at = (page.left + page.cell / 2) / page.width;
    materials["a | b"] = {{"model", "split"}, {"at", Json::array({at})}, {"materials", {"a", "b"}}};
    shapes.push_back(SheetSphere(0, "a | b"));
  } else {
    shapes = {SheetSphere(-0.5, "a"), SheetSphere(0.5, "b")};
  }
  const std::string scene = SheetScene(shapes, materials, request, page, lighting);
  RunRenderJob(
      options, InputFiles(arguments.sheet.lighting),
      [&](const LoadOptions& load) {
        return LoadSheet(scene, "nacre pair", arguments.sheet, page, load);
      },
      page.text);
}

void Report(const PairArguments& arguments, const Side& a, const Side& b,
            const DifferenceMeasures* measures) {
  if (arguments.json) {
    Json json = {{"a", a.complete}, {"b", b.complete}};
    if (measures != nullptr) json["difference"] = measures->ToJson();
    PrintOut(JsonText(json, 2) + "\n");
    return;
  }
  if (arguments.options.quiet) return;
  PrintOut("A  {}\nB  {}\n", DescribeMaterial(a.complete), DescribeMaterial(b.complete));
  if (measures != nullptr) {
    PrintOut("A - B on the sphere, linear: RMSE {:.6g}, largest {:.6g}, mean {:+.6g}\n",
             measures->rmse, measures->max, measures->mean);
  }
}

void RunPair(const PairArguments& arguments, const CLI::App& command) {
  const Side a = ReadSide("--a", arguments.a);
  const Side b = ReadSide("--b", arguments.b);
  if (arguments.layout != "difference") {
    RenderBoth(arguments, a, b);
    Report(arguments, a, b, nullptr);
    return;
  }
  RefuseWhatNoDifferencePageTakes(command, "--layout difference");
  DifferencePage page{
      a.json, b.json, a.label, b.label, Title(arguments, a, b), Footer(arguments, a, b)};
  const DifferenceMeasures measures = DrawDifference(page, arguments.sheet, arguments.options,
                                                     "nacre pair", arguments.options.outputs);
  Report(arguments, a, b, &measures);
}

}  // namespace

void AddPairCommand(CLI::App* app, int*) {
  CLI::App* command = app->add_subcommand("pair", "Render two materials under the same light");
  const auto arguments = std::make_shared<PairArguments>();
  command->add_option("--a", arguments->a, "Left material: a model's name, JSON, or FILE.mtlx#NAME")
      ->capture_default_str();
  command
      ->add_option("--b", arguments->b, "Right material: a model's name, JSON, or FILE.mtlx#NAME")
      ->capture_default_str();
  command
      ->add_option("--layout", arguments->layout,
                   "split (halves of one sphere), side (by side) or difference (A, B and where "
                   "they differ, with RMSE, largest and mean difference; PNG only)")
      ->check(CLI::IsMember({"split", "side", "difference"}))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "Print both materials and the measures as JSON");
  AddSheetOptions(command, &arguments->sheet, &arguments->options);
  command->footer(
      "Prints both materials with all their numbers.\n"
      "Examples:\n"
      "  nacre pair -o phong_vs_pbr.png\n"
      "  nacre pair --a blinn_phong --b phong --layout side -o lobes.png --spp 64\n"
      "  nacre pair --layout difference --light studio -o difference.png --json");
  command->callback([arguments, command] { RunPair(*arguments, *command); });
}

}  // namespace nacre
