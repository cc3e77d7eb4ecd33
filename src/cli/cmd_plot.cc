// SPDX-License-Identifier: Apache-2.0
// cli/cmd_plot.cc: nacre plot: reflection models, lights and tone operators as curves.
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/outputs.h"
#include "cli/plot_inputs.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/render_options.h"
#include "image_io/output_file.h"
#include "report/plot.h"
#include "study/light_curves.h"

namespace nacre {
namespace {

struct Arguments {
  std::string kind;
  std::vector<std::string> outputs;
  PlotInputs inputs;
  CurveOptions curves;
  std::string channel = "luminance";
  std::string title;
  std::string size = "1280x800";
  double exposure = 0;
  bool one_light = false;
};

const std::vector<PlotItem> kModels = {
    {"Lambert", R"({"model": "lambert", "albedo": 0.5})"},
    {"Phong, n = 32", R"({"model": "phong", "kd": 0.5, "ks": 0.3, "shininess": 32})"},
    {"Blinn-Phong, n = 128", R"({"model": "blinn_phong", "kd": 0.5, "ks": 0.3, "shininess": 128})"},
    {"GGX dielectric, roughness 0.35",
     R"({"model": "metallic_roughness", "base_color": 0.5, "roughness": 0.35})"},
    {"GGX metal, roughness 0.5",
     R"({"model": "metallic_roughness", "base_color": 0.9, "metallic": 1, "roughness": 0.5})"},
};

PlotItem Metal(double roughness, const std::string& rest, const std::string& label) {
  return {label, fmt::format(R"({{"model": "metallic_roughness", "base_color": 1, "metallic": 1, )"
                             R"("roughness": {}{}}})",
                             roughness, rest)};
}

std::vector<PlotItem> DistributionDefaults() {
  std::vector<PlotItem> items;
  for (const double roughness : {0.1, 0.2, 0.4, 0.7, 1.0}) {
    items.push_back(Metal(roughness, "", fmt::format("GGX, roughness {}", roughness)));
  }
  // 2 / alpha^2 - 2 for roughness 0.4, which has the same peak.
  items.push_back({"Blinn-Phong, n = 76", R"({"model": "blinn_phong", "shininess": 76})"});
  return items;
}

std::vector<PlotItem> MaskingDefaults() {
  std::vector<PlotItem> items;
  for (const double roughness : {0.3, 0.8}) {
    for (const char* form : {"height_correlated", "separable", "schlick_direct"}) {
      items.push_back(Metal(roughness, fmt::format(R"(, "shadowing": "{}")", form),
                            fmt::format("{}, roughness {}", form, roughness)));
    }
  }
  return items;
}

std::vector<PlotItem> AlbedoDefaults() {
  const std::string single = R"(, "compensation": "none")";
  return {
      Metal(0.4, single, "metal, roughness 0.4, one bounce"),
      Metal(0.7, single, "metal, roughness 0.7, one bounce"),
      Metal(1, single, "metal, roughness 1, one bounce"),
      Metal(1, "", "metal, roughness 1, compensated"),
      {"dielectric, base by 1 - F(v.h)",
       R"({"model": "metallic_roughness", "base_color": 1, "roughness": 0.3, )"
       R"("diffuse_coupling": "one_minus_fresnel"})"},
      {"dielectric, base by albedo",
       R"({"model": "metallic_roughness", "base_color": 1, "roughness": 0.3})"},
  };
}

const std::vector<PlotItem> kInterfaces = {
    {"Schlick's curve, F0 = 0.04", R"({"model": "metallic_roughness"})"},
    {"glass (1.5), exact", R"({"model": "dielectric", "preset": "glass"})"},
    {"diamond (2.417), exact", R"({"model": "dielectric", "preset": "diamond"})"},
    {"iron, exact", R"({"model": "conductor", "preset": "iron"})"},
    {"gold, exact", R"({"model": "conductor", "preset": "gold"})"},
    {"aluminium, exact", R"({"model": "conductor", "preset": "aluminium"})"},
};

// All have the intensity 1 from afar.
const std::vector<PlotItem> kLights = {
    {"point, 1 / d²", R"({"type": "point", "position": [0, 0, 0], "intensity": 1})"},
    {"point, 1 / (1 + 0.1 d²)",
     R"({"type": "point", "position": [0, 0, 0], "intensity": 1, )"
     R"("attenuation": {"constant": 1, "linear": 0, "quadratic": 0.1}})"},
    {"sphere, radius 0.5",
     R"({"type": "sphere", "center": [0, 0, 0], "radius": 0.5, "radiance": 1.2732395447351628})"},
    {"disk, radius 1",
     R"({"type": "disk", "center": [0, 0, 0], "facing": [0, -1, 0], "radius": 1, )"
     R"("radiance": 0.3183098861837907})"},
    {"rectangle, 4 by 0.25",
     R"({"type": "rectangle", "center": [0, 0, 0], "facing": [0, -1, 0], "up": [0, 0, -1], )"
     R"("width": 4, "height": 0.25, "radiance": 1})"},
};

ColorChannel ParseChannel(const std::string& name) {
  if (name == "red") return ColorChannel::kRed;
  if (name == "green") return ColorChannel::kGreen;
  if (name == "blue") return ColorChannel::kBlue;
  return ColorChannel::kLuminance;
}

// Throws Error (bad input) unless `has` holds of every material.
void Require(const std::vector<NamedMaterial>& materials, bool (*has)(const ShadingMaterial&),
             const char* what, const char* hint) {
  for (const NamedMaterial& named : materials) {
    if (!has(named.material)) {
      throw Error(ExitCode::kBadInput, named.label, fmt::format("has no {}", what), hint);
    }
  }
}

// What the numbers are of.
CurveOptions Complete(const Arguments& arguments) {
  CurveOptions options = arguments.curves;
  options.channel = ParseChannel(arguments.channel);
  if (options.angles_deg.empty()) options.angles_deg = {45};
  return options;
}

Plot DrawBrdf(const Arguments& a) {
  return BrdfPlot(ReadPlotMaterials(a.inputs, kModels), Complete(a));
}

Plot DrawPolar(const Arguments& a) {
  return PolarPlot(ReadPlotMaterials(a.inputs, kModels), Complete(a));
}

Plot DrawDistribution(const Arguments& a) {
  const std::vector<NamedMaterial> materials = ReadPlotMaterials(a.inputs, DistributionDefaults());
  Require(materials, HasDistribution, "distribution of normals",
          "blinn_phong and the models with a roughness above 0 have one");
  return DistributionPlot(materials);
}

Plot DrawMasking(const Arguments& a) {
  const std::vector<NamedMaterial> materials = ReadPlotMaterials(a.inputs, MaskingDefaults());
  Require(materials, HasMasking, "masking", "the models with a roughness have one");
  return MaskingPlot(materials);
}

Plot DrawFresnel(const Arguments& a) {
  const std::vector<NamedMaterial> materials = ReadPlotMaterials(a.inputs, kInterfaces);
  Require(materials, HasFresnel, "Fresnel term", "the models with a roughness have one");
  return FresnelPlot(materials, Complete(a).channel);
}

Plot DrawAlbedo(const Arguments& a) {
  return AlbedoPlot(ReadPlotMaterials(a.inputs, AlbedoDefaults()),
                    a.one_light ? ShareOf::kOneLight : ShareOf::kFurnace, Complete(a).channel);
}

Plot DrawTone(const Arguments& a) { return TonePlot(a.exposure); }

Plot DrawFalloff(const Arguments& a) {
  const std::vector<Light> lights = ReadPlotLights(a.inputs, kLights);
  for (const Light& light : lights) {
    if (!HasFalloff(light)) {
      throw Error(ExitCode::kBadInput, light.name,
                  "is all around, or has no centre to measure a distance from",
                  "name a light with a position, a centre or a direction");
    }
  }
  return FalloffPlot(lights);
}

struct Kind {
  const char* name;
  const char* help;
  Plot (*draw)(const Arguments&);
};
constexpr Kind kKinds[] = {
    {"brdf", "the BRDF over the light's angle in the plane of incidence", DrawBrdf},
    {"polar", "what light from one angle leaves by, as a lobe", DrawPolar},
    {"ndf", "the distribution of the microfacets' normals", DrawDistribution},
    {"masking", "the share of microfacets that are lit and seen", DrawMasking},
    {"fresnel", "the reflectance of the interface over the angle of incidence", DrawFresnel},
    {"albedo", "how much light is reflected in all, over the angle", DrawAlbedo},
    {"tone", "every tone operator", DrawTone},
    {"falloff", "a light's irradiance over its distance", DrawFalloff},
};

const Kind& FindKind(const std::string& name) {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) {
    if (name == kind.name) return kind;
    names.emplace_back(kind.name);
  }
  const std::string nearest = NearestName(name, names);
  throw Error(ExitCode::kUsage, "", fmt::format("unknown plot \"{}\"", name),
              nearest.empty() ? fmt::format("the plots are {}", fmt::join(names, ", "))
                              : fmt::format("did you mean \"{}\"?", nearest));
}

void RunPlot(const Arguments& arguments) {
  const Kind& kind = FindKind(arguments.kind);
  std::vector<std::string> paths = arguments.outputs;
  for (const std::string& path : paths) {
    CheckFigurePath(path);
    CheckWritable(path);
  }
  if (!arguments.inputs.scene.empty()) paths.push_back(arguments.inputs.scene);
  CheckPathsDiffer(paths);
  Plot plot = kind.draw(arguments);
  plot.title = arguments.title;
  Figure figure = MakeFigure(std::move(plot));
  ParseSize(arguments.size, &figure.width, &figure.height);
  for (const std::string& path : arguments.outputs) {
    ThrowIfStopped();
    WriteFigure(path, figure);
  }
}

std::string KindHelp() {
  std::string help;
  for (const Kind& kind : kKinds)
    help += fmt::format("{}{}: {}", help.empty() ? "" : "; ", kind.name, kind.help);
  return help;
}

void AddPlotOptions(CLI::App* command, Arguments* a) {
  command->add_option("KIND", a->kind, KindHelp())->required();
  command->add_option("-o,--output", a->outputs, "File to write, .svg, .png or .csv; repeatable")
      ->required()
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      ->add_option("--scene", a->inputs.scene,
                   "Scene or model whose materials and lights are drawn: all, or those named")
      ->type_name("FILE");
  command
      ->add_option("--material", a->inputs.materials,
                   "A material of the scene by name, a model by name, or JSON; repeatable")
      ->allow_extra_args(false);
  command
      ->add_option("--light", a->inputs.lights,
                   "A light of the scene by name, or JSON (falloff); repeatable")
      ->allow_extra_args(false);
}

void AddCurveOptions(CLI::App* command, Arguments* a) {
  command
      ->add_option("--angle", a->curves.angles_deg,
                   "Degrees from the normal: of the viewer (brdf) or the light (polar); several by "
                   "commas (45 if not given)")
      ->delimiter(',')
      ->check(InRange(0, 89.9));
  command->add_option("--channel", a->channel, "Of colours: luminance, red, green or blue")
      ->check(CLI::IsMember({"luminance", "red", "green", "blue"}))
      ->capture_default_str();
  command->add_flag("--log", a->curves.log, "Logarithmic BRDF");
  command->add_flag("--cosine", a->curves.times_cosine, "The BRDF times the light's cosine");
  command->add_flag("--kernel", a->curves.kernel,
                    "Also, as marks, what the SIMD kernels compute in float (brdf, polar)");
  command->add_flag("--one-light", a->one_light,
                    "Of light from one angle, all that is reflected (albedo); else what is seen at "
                    "that angle under equal light from everywhere");
  command->add_option("--exposure", a->exposure, "In stops (tone)")
      ->check(InRange(-60, 60))
      ->capture_default_str();
  command->add_option("--title", a->title, "Written above");
  command->add_option("--size", a->size, "Width and height in pixels")
      ->type_name("WxH")
      ->capture_default_str();
  command->add_flag("--allow-paths", a->inputs.allow_paths,
                    "Let the scene refer to files outside its own folder");
}

}  // namespace

void AddPlotCommand(CLI::App* app, int*) {
  CLI::App* command = app->add_subcommand(
      "plot", "Draw reflection models, lights and tone operators as curves (SVG, PNG, CSV)");
  const auto arguments = std::make_shared<Arguments>();
  AddPlotOptions(command, arguments.get());
  AddCurveOptions(command, arguments.get());
  command->footer(
      "Numbers are computed in double by the scalar twins of the kernels. gnuplot draws.\n"
      "Examples:\n"
      "  nacre plot fresnel -o fresnel.png\n"
      "  nacre plot brdf --angle 30,60 --log --material phong --material blinn_phong -o brdf.svg\n"
      "  nacre plot polar --material '{\"model\": \"metallic_roughness\", \"roughness\": 0.3}' -o "
      "lobe.png\n"
      "  nacre plot albedo --scene scenes/first_scene.json -o albedo.svg -o albedo.csv\n"
      "  nacre plot falloff -o falloff.png");
  command->callback([arguments] { RunPlot(*arguments); });
}

}  // namespace nacre
