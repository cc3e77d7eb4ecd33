// SPDX-License-Identifier: Apache-2.0
// cli/cmd_plot.cc: nacre plot: plots reflection models, lights and tone operators as curves.
#include <algorithm>
#include <memory>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/help_text.h"
#include "cli/outputs.h"
#include "cli/plot_inputs.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/render_options.h"
#include "cli/usage_error.h"
#include "image_io/output_file.h"
#include "report/plot.h"
#include "study/light_curves.h"
#include "study/material_curves.h"

namespace nacre {
namespace {

struct PlotArguments {
  std::string kind;
  PlotInputs inputs;  // inputs.outputs are the plot's files
  CurveOptions curves;
  std::string channel = "luminance";
  std::string title;
  std::string size;  // empty: 1280x800, or as large as slices need
  double exposure = 0;
  bool one_light = false;
};

ColorChannel ParseChannel(const std::string& name) {
  if (name == "red") return ColorChannel::kRed;
  if (name == "green") return ColorChannel::kGreen;
  if (name == "blue") return ColorChannel::kBlue;
  return ColorChannel::kLuminance;
}

// ReadPlotMaterials. Throws Error (kBadInput) unless `has` is true for every material.
std::vector<NamedMaterial> ReadMaterialsWith(const PlotArguments& a,
                                             const std::vector<PlotItem>& defaults,
                                             bool (*has)(const ShadingMaterial&), const char* what,
                                             const char* hint) {
  std::vector<NamedMaterial> materials = ReadPlotMaterials(a.inputs, defaults);
  for (const NamedMaterial& named : materials) {
    if (has(named.material)) continue;
    throw Error(ExitCode::kBadInput, named.label, fmt::format("has no {}", what), hint);
  }
  return materials;
}

// The options with defaults filled in.
CurveOptions Complete(const PlotArguments& arguments) {
  CurveOptions options = arguments.curves;
  options.channel = ParseChannel(arguments.channel);
  if (options.angles_deg.empty()) options.angles_deg = {45};
  return options;
}

// The panels of a figure.
using Plots = std::vector<Plot>;

Plots DrawFalloff(const PlotArguments& a) {
  std::vector<Light> lights;
  std::vector<std::string> without;
  for (Light& light : ReadPlotLights(a.inputs, DefaultLights())) {
    if (HasFalloff(light)) {
      lights.push_back(std::move(light));
    } else {
      without.push_back(light.name);
    }
  }
  // Lights of a scene that have no such curve are left out; for lights named explicitly it is an
  // error.
  const bool asked = !a.inputs.lights.empty();
  if (!without.empty() && (asked || lights.empty())) {
    throw Error(ExitCode::kBadInput, without[0],
                "is all around, or has no centre to measure a distance from",
                "name a light with a position, a centre or a direction");
  }
  for (const std::string& name : without) {
    PrintError(
        "note: \"{}\" is left out: it is all around, or has no centre to measure a distance from\n",
        name);
  }
  return {FalloffPlot(lights)};
}

constexpr char kWithRoughness[] = "the models with a roughness have one";

struct PlotKind {
  const char* name;
  const char* help;
  Plots (*draw)(const PlotArguments&);
  std::set<std::string> options;  // options of this kind, besides those common to all kinds
};
const std::vector<PlotKind> kPlotKinds = {
    {"brdf",
     "the BRDF over the light's angle in the plane of incidence",
     [](const PlotArguments& a) -> Plots {
       return {BrdfPlot(ReadPlotMaterials(a.inputs, DefaultModels()), Complete(a))};
     },
     {"--material", "--angle", "--channel", "--log", "--cosine", "--kernel"}},
    {"polar",
     "how light from one angle is reflected, as a lobe",
     [](const PlotArguments& a) -> Plots {
       return {PolarPlot(ReadPlotMaterials(a.inputs, DefaultModels()), Complete(a))};
     },
     {"--material", "--angle", "--channel", "--kernel"}},
    {"slice",
     "the BRDF as colours over the angles of half vector and light",
     [](const PlotArguments& a) {
       return SlicePlots(ReadPlotMaterials(a.inputs, DefaultModels()), Complete(a).channel);
     },
     {"--material", "--channel"}},
    {"ndf",
     "the distribution of the microfacets' normals",
     [](const PlotArguments& a) -> Plots {
       return {DistributionPlot(
           ReadMaterialsWith(a, DefaultDistributions(), HasDistribution, "distribution of normals",
                             "blinn_phong and the models with a roughness above 0 have one"))};
     },
     {"--material"}},
    {"masking",
     "the share of microfacets that are lit and seen",
     [](const PlotArguments& a) -> Plots {
       return {MaskingPlot(
           ReadMaterialsWith(a, DefaultMaskings(), HasMicrofacets, "masking", kWithRoughness))};
     },
     {"--material"}},
    {"fresnel",
     "the reflectance of the interface over the angle of incidence",
     [](const PlotArguments& a) -> Plots {
       return {FresnelPlot(ReadMaterialsWith(a, DefaultInterfaces(), HasMicrofacets, "Fresnel term",
                                             kWithRoughness),
                           Complete(a).channel)};
     },
     {"--material", "--channel"}},
    {"albedo",
     "the directional albedo: how much light is reflected in all",
     [](const PlotArguments& a) -> Plots {
       return {AlbedoPlot(ReadPlotMaterials(a.inputs, DefaultAlbedos()),
                          a.one_light ? ShareOf::kOneLight : ShareOf::kFurnace,
                          Complete(a).channel)};
     },
     {"--material", "--channel", "--one-light"}},
    {"tone",
     "every tone operator",
     [](const PlotArguments& a) -> Plots { return {TonePlot(a.exposure)}; },
     {"--exposure"}},
    {"falloff", "a light's irradiance over its distance", DrawFalloff, {"--light"}},
};

void RefuseWhatCannotApply(const PlotKind& kind, const CLI::App& command) {
  static const std::set<std::string> kOfAll = {"KIND", "--output", "--title", "--size"};
  static const std::set<std::string> kOfScenes = {"--scene", "--allow-paths"};
  const bool takes_scene = kind.options.contains("--material") || kind.options.contains("--light");
  RefuseOptions(
      command,
      [&](const CLI::Option& option) {
        const std::string name = option.get_name();
        return kOfAll.contains(name) || kind.options.contains(name) ||
               (takes_scene && kOfScenes.contains(name));
      },
      fmt::format("nacre plot {}", kind.name),
      fmt::format("of its own it takes {}", fmt::join(kind.options, ", ")));
}

const PlotKind& FindKind(const std::string& name) {
  const auto found = std::ranges::find(kPlotKinds, name, &PlotKind::name);
  if (found != kPlotKinds.end()) return *found;
  const std::vector<std::string> names = NamesOf(kPlotKinds);
  throw Error(ExitCode::kUsage, "", fmt::format("unknown plot \"{}\"", name),
              NearestHint(name, names, fmt::format("the plots are {}", fmt::join(names, ", "))));
}

// Arranges panels in rows of at most three, with a title above.
Figure Arrange(Plots plots, const std::string& title) {
  if (plots.size() == 1) {
    if (!title.empty()) plots[0].title = title;
    return MakeFigure(std::move(plots[0]));
  }
  Figure figure;
  figure.title = title;
  figure.columns = static_cast<int>(std::min<size_t>(plots.size(), 3));
  const auto rows = static_cast<int>((plots.size() + 2) / 3);
  figure.width = 800 * figure.columns;
  figure.height = 640 * rows + (title.empty() ? 0 : 40);
  figure.panels = std::move(plots);
  return figure;
}

void RunPlot(const PlotArguments& arguments, const CLI::App& command) {
  const PlotKind& kind = FindKind(arguments.kind);
  RefuseWhatCannotApply(kind, command);
  for (const std::string& path : arguments.inputs.outputs) {
    CheckFigurePath(path);
    CheckWritable(path);
  }
  CheckPathsDiffer(arguments.inputs.outputs);
  CheckOutputsAreNoInputs(arguments.inputs.outputs, {arguments.inputs.scene});
  Figure figure = Arrange(kind.draw(arguments), arguments.title);
  if (!arguments.size.empty()) ParseSize(arguments.size, &figure.width, &figure.height);
  for (const std::string& path : arguments.inputs.outputs) {
    ThrowIfStopped();
    WriteFigure(path, figure);
    NoteWritten(path);
  }
}

std::string KindHelp() {
  std::string names, kinds;
  for (const PlotKind& kind : kPlotKinds) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", kind.name);
    kinds += fmt::format("; {}: {}", kind.name, kind.help);
  }
  return names + kinds;
}

void AddPlotOptions(CLI::App* command, PlotArguments* a) {
  command->add_option("KIND", a->kind, KindHelp())->required();
  command
      ->add_option("-o,--output", a->inputs.outputs,
                   "File to write, repeatable: .svg, .png or .csv")
      ->required()
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      ->add_option("--scene", a->inputs.scene,
                   "Scene or model whose materials and lights are drawn: all, or those named")
      ->type_name("FILE");
  command
      ->add_option(
          "--material", a->inputs.materials,
          "A material of the scene by name, a model by name, JSON, or FILE.mtlx#NAME; repeatable")
      ->allow_extra_args(false);
  command
      ->add_option("--light", a->inputs.lights,
                   "A light of the scene by name, or JSON (falloff); repeatable")
      ->allow_extra_args(false);
}

void AddCurveOptions(CLI::App* command, PlotArguments* a) {
  command
      ->add_option("--angle", a->curves.angles_deg,
                   "Degrees from the normal, of the viewer (brdf) or the light (polar); several "
                   "are separated by commas (45 if not given)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(InRange(0, 89.9));
  command->add_option("--channel", a->channel, "Channel of colours: luminance, red, green or blue")
      ->check(CLI::IsMember({"luminance", "red", "green", "blue"}))
      ->capture_default_str();
  command->add_flag("--log", a->curves.log, "Logarithmic scale (brdf)");
  command->add_flag("--cosine", a->curves.times_cosine, "Multiply the BRDF by the light's cosine");
  command->add_flag("--kernel", a->curves.kernel,
                    "Add, as marks, what the SIMD kernels compute in float (brdf, polar)");
  command->add_flag("--one-light", a->one_light,
                    "The share of light from one angle that is reflected (albedo); if not given, "
                    "what is seen at that angle under equal light from everywhere");
  command->add_option("--exposure", a->exposure, "Exposure in stops (tone)")
      ->check(InRange(-60, 60))
      ->capture_default_str();
  command->add_option("--title", a->title, "Title above the diagram");
  command
      ->add_option("--size", a->size,
                   "Width and height in pixels (1280x800; of several slices 800x640 each)")
      ->type_name("WxH");
  command->add_flag("--allow-paths", a->inputs.allow_paths,
                    "Let the scene refer to files outside its own folder");
  MoveBehindHelpAll(command,
                    {"--channel", "--kernel", "--one-light", "--exposure", "--allow-paths"});
}

}  // namespace

void AddPlotCommand(CLI::App* app, int*) {
  CLI::App* command = app->add_subcommand(
      "plot", "Draw reflection models, lights and tone operators as curves (SVG, PNG, CSV)");
  const auto arguments = std::make_shared<PlotArguments>();
  AddPlotOptions(command, arguments.get());
  AddCurveOptions(command, arguments.get());
  command->footer(
      "Curves are computed in double by the formulas of the papers and drawn by gnuplot.\n"
      "Examples:\n"
      "  nacre plot fresnel -o fresnel.png\n"
      "  nacre plot brdf --angle 30,60 --log --material phong --material blinn_phong -o brdf.svg\n"
      "  nacre plot polar --material '{\"model\": \"metallic_roughness\", \"roughness\": 0.3}' "
      "-o lobe.png\n"
      "  nacre plot slice --material phong --material metallic_roughness -o slices.png\n"
      "  nacre plot albedo --scene scenes/first_scene.json -o albedo.svg -o albedo.csv\n"
      "  nacre plot falloff -o falloff.png");
  command->callback([arguments, command] { RunPlot(*arguments, *command); });
}

}  // namespace nacre
