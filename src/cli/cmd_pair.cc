// cli/cmd_pair.cc: nacre pair: two materials side by side, or as halves of one sphere.
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/render_job.h"
#include "cli/sheet.h"

namespace nacre {
namespace {

using Json = nlohmann::json;

struct Arguments {
  // The same red plastic twice: shininess 2 / alpha^2 - 2 for roughness 0.4, ks = F0.
  std::string a = R"({"model": "phong", "color": [0.8, 0.2, 0.2], "kd": 0.96, "ks": 0.04, )"
                  R"("ka": 0.96, "shininess": 19})";
  std::string b = R"({"model": "metallic_roughness", "base_color": [0.8, 0.2, 0.2], )"
                  R"("roughness": 0.4})";
  std::string layout = "split";
  RenderOptions options;
};

std::string PairScene(const Arguments& arguments) {
  Json materials = {{"a", ParseMaterialArgument("--a", arguments.a)},
                    {"b", ParseMaterialArgument("--b", arguments.b)}};
  const auto sphere = [](double x, const char* material) -> Json {
    return {{"type", "sphere"}, {"center", {x, 0, 0}}, {"radius", 1}, {"material", material}};
  };
  if (arguments.layout == "side") {
    const Json shapes = Json::array({sphere(-1.15, "a"), sphere(1.15, "b")});
    return SheetScene(shapes, materials, 5, 2.7);
  }
  materials["a | b"] = {{"model", "split"}, {"at", {0.5}}, {"materials", {"a", "b"}}};
  return SheetScene(Json::array({sphere(0, "a | b")}), materials, 3, 2.7);
}

}  // namespace

void AddPairCommand(CLI::App* app, int*) {
  CLI::App* command = app->add_subcommand("pair", "Render two materials under the same light");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("--a", arguments->a, "Left material: a model's name or JSON")
      ->capture_default_str();
  command->add_option("--b", arguments->b, "Right material: a model's name or JSON")
      ->capture_default_str();
  command->add_option("--layout", arguments->layout, "split (halves of one sphere) or side")
      ->check(CLI::IsMember({"split", "side"}))
      ->capture_default_str();
  AddRenderOptions(command, &arguments->options);
  command->footer(
      "Examples:\n"
      "  nacre pair -o phong_vs_pbr.png\n"
      "  nacre pair --a blinn_phong --b phong --layout side -o lobes.png --spp 64");
  command->callback([arguments] {
    const std::string scene = PairScene(*arguments);
    RunRenderJob(arguments->options, "", [&](const LoadOptions& load) {
      return LoadSceneText(scene, "nacre pair", ".", load);
    });
  });
}

}  // namespace nacre
