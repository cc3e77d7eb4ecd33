// SPDX-License-Identifier: Apache-2.0
#include "cli/sheet.h"

#include "base/error.h"
#include "cli/help_text.h"
#include "color/display.h"
#include "color/luminance.h"
#include "scene_io/materialx.h"

namespace nacre {

std::string SheetScene(const Json& shapes, const Json& materials, const SheetRequest& request,
                       const SheetPage& page, const Lighting& lighting) {
  // The origin is in the middle of the block of cells; the camera looks at the middle of the
  // picture.
  const double x = (page.width / 2.0 - page.left) / page.cell - request.columns / 2.0;
  const double y = request.rows / 2.0 - (page.height / 2.0 - page.top) / page.cell;
  constexpr double kDistance = 100;
  // No shadows: spheres do not affect each other's light.
  const Json scene = {
      {"nacre", 1},
      {"camera",
       {{"type", "orthographic"},
        {"position", {x, y, kDistance}},
        {"look_at", {x, y, 0}},
        {"height", page.height / page.cell}}},
      {"image",
       {{"width", page.width},
        {"height", page.height},
        {"spp", lighting.sampled ? 64 : 16},
        {"shadows", false}}},
      {"lights", lighting.lights},
      {"materials", materials},
      {"shapes", shapes},
      {"background", lighting.background},
  };
  return JsonText(scene);
}

Json SheetSphere(double x, const Json& material) {
  return {{"type", "sphere"},
          {"center", {x, 0, 0}},
          {"radius", kSheetSphereRadius},
          {"material", material}};
}

void AddSheetOptions(CLI::App* command, SheetOptions* options, RenderOptions* render) {
  command
      ->add_option("--sphere-size", options->sphere_size,
                   "Diameter of the spheres in pixels; the picture grows with them")
      ->check(InRange(1, 8192))
      ->type_name("PX")
      ->group("Sheet");
  command->add_option("--title", options->title, "Title above the picture; - for none")
      ->group("Sheet");
  AddLightingOptions(command, &options->lighting);
  render->labels = true;
  AddRenderOptions(command, render);
  MoveBehindHelpAll(command, {"--title", "--sphere-size", "--lights", "--exposure", "--max-error",
                              "--set", "--layers", "--explain"});
}

std::string SheetTitle(const SheetOptions& options, const std::string& by_default) {
  if (options.title == "-") return {};
  return options.title.empty() ? by_default : options.title;
}

namespace {

// Whether the ground is light in a PNG, so that text should be dark.
bool IsLightGround(const Lighting& lighting, const RenderOptions& render) {
  const Json& background = lighting.background;
  Imath::Color3<double> rgb;
  for (int c = 0; c < 3; ++c) {
    const auto i = static_cast<size_t>(c);
    rgb[c] = background.is_array() ? background[i].get<double>() : background.get<double>();
  }
  // At luminance 0.18, the contrasts with black and with white are equal (WCAG 2.1).
  return Luminance(DisplayLight(render.display, rgb)) > 0.18;
}

}  // namespace

SheetRequest MakeSheetRequest(const SheetOptions& options, const RenderOptions& render,
                              const Lighting& lighting, int rows, int columns) {
  SheetRequest request;
  request.rows = rows;
  request.columns = columns;
  request.light_ground = IsLightGround(lighting, render);
  if (options.sphere_size > 0) request.cell = options.sphere_size / (2 * kSheetSphereRadius);
  if (!render.size.empty()) {
    if (options.sphere_size > 0) {
      throw Error(ExitCode::kUsage, "--sphere-size", "the picture's size is given as well",
                  "give --size for the whole picture or --sphere-size for each sphere");
    }
    ParseSize(render.size, &request.width, &request.height);
  }
  return request;
}

Scene LoadSheet(const std::string& text, const std::string& command, const SheetOptions& options,
                const SheetPage& page, LoadOptions load) {
  load.trusted_files = {options.lighting.environment};
  // Materials come from the command line; lights may be somebody else's file.
  const Json scene_json = TryParseJson(text).value_or(Json::object());
  for (const char* const part : {"materials", "shapes"}) {
    for (auto& file : MaterialXFilesIn(scene_json.value(part, Json()))) {
      load.trusted_files.push_back(std::move(file));
    }
  }
  if (page.width > 65536 || page.height > 65536) {
    throw Error(ExitCode::kUsage, "--sphere-size", "the picture would be larger than 65536 pixels",
                "give smaller spheres");
  }
  Scene scene = LoadSceneText(text, command, ".", load);
  scene.labels.clear();  // the page draws the labels
  return scene;
}

}  // namespace nacre
