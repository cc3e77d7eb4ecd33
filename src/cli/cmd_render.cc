// cli/cmd_render.cc: nacre render SCENE -o FILE...
#include <memory>

#include "cli/commands.h"
#include "cli/render_job.h"

namespace nacre {

void AddRenderCommand(CLI::App* app, int*) {
  CLI::App* command = app->add_subcommand("render", "Render a scene file to EXR and PNG");
  struct Arguments {
    std::string scene;
    RenderOptions options;
  };
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("SCENE", arguments->scene, "Scene file (.json)")->required();
  AddRenderOptions(command, &arguments->options);
  command->footer(
      "Examples:\n"
      "  nacre render scenes/material_grid.json -o grid.exr -o grid.png --labels\n"
      "  nacre render scenes/phong_vs_pbr.json -o half.png --spp 64 --set /image/width=800\n"
      "  nacre render scene.json -o all.exr --layers all --depth float --explain");
  command->callback([arguments] {
    RunRenderJob(arguments->options, arguments->scene,
                 [&](const LoadOptions& load) { return LoadScene(arguments->scene, load); });
  });
}

}  // namespace nacre
