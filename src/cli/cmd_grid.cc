// cli/cmd_grid.cc: nacre grid: a sheet of spheres over two material parameters, without a file.
#include <charconv>
#include <memory>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/render_job.h"
#include "cli/sheet.h"

namespace nacre {
namespace {

using Json = nlohmann::json;

// "PARAMETER=FROM:TO:COUNT" as an axis of the scene format's grid.
Json ParseAxis(const std::string& option, const std::string& text) {
  const size_t equals = text.find('=');
  const size_t first = text.find(':', equals);
  const size_t second = first == std::string::npos ? first : text.find(':', first + 1);
  Json axis;
  int count = 0;
  if (equals != std::string::npos && second != std::string::npos) {
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + second + 1, end, count);
    const Json from = Json::parse(text.substr(equals + 1, first - equals - 1), nullptr, false);
    const Json to = Json::parse(text.substr(first + 1, second - first - 1), nullptr, false);
    if (error == std::errc() && rest == end && !from.is_discarded() && !to.is_discarded()) {
      axis = {{"parameter", text.substr(0, equals)}, {"from", from}, {"to", to}, {"count", count}};
    }
  }
  if (axis.is_null()) {
    throw Error(ExitCode::kUsage, option, "\"" + text + "\" is not PARAMETER=FROM:TO:COUNT",
                "for example roughness=0.1:0.9:5, or base_color=[1,0,0]:[0,0,1]:4");
  }
  return axis;
}

struct Arguments {
  std::string rows = "roughness=0.1:0.9:5";
  std::string columns = "metallic=0:1:5";
  std::string material = R"({"model": "metallic_roughness", "base_color": [0.9, 0.6, 0.2]})";
  RenderOptions options;
};

std::string GridScene(const Arguments& arguments) {
  const Json rows = ParseAxis("--rows", arguments.rows);
  const Json columns = ParseAxis("--columns", arguments.columns);
  const Json shapes = {{{"type", "grid"},
                        {"material", ParseMaterialArgument("--material", arguments.material)},
                        {"rows", rows},
                        {"columns", columns}}};
  // Half a sphere's room for the column labels, two for those of the rows.
  return SheetScene(shapes, Json::object(), columns["count"].get<double>() + 4,
                    rows["count"].get<double>() + 1);
}

}  // namespace

void AddGridCommand(CLI::App* app, int*) {
  CLI::App* command =
      app->add_subcommand("grid", "Render a grid of spheres over two material parameters");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("--rows", arguments->rows, "Parameter that varies downwards")
      ->type_name("PARAMETER=FROM:TO:COUNT")
      ->capture_default_str();
  command->add_option("--columns", arguments->columns, "Parameter that varies to the right")
      ->type_name("PARAMETER=FROM:TO:COUNT")
      ->capture_default_str();
  command->add_option("--material", arguments->material, "Model's name or material as JSON")
      ->capture_default_str();
  AddRenderOptions(command, &arguments->options);
  command->footer(
      "Examples:\n"
      "  nacre grid -o grid.png --labels\n"
      "  nacre grid --material phong --rows shininess=4:256:4 --columns ks=0:1:6 -o phong.png");
  command->callback([arguments] {
    const std::string scene = GridScene(*arguments);
    RunRenderJob(arguments->options, "", [&](const LoadOptions& load) {
      return LoadSceneText(scene, "nacre grid", ".", load);
    });
  });
}

}  // namespace nacre
