// SPDX-License-Identifier: Apache-2.0
// cli/cmd_render.cc: nacre render SCENE -o FILE...
#include <memory>

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/help_text.h"
#include "cli/render_job.h"
#include "cli/textbook_job.h"
#include "cli/watch_job.h"

namespace nacre {

void AddRenderCommand(CLI::App* app, int* exit_code) {
  CLI::App* command =
      app->add_subcommand("render", "Render a scene file or a model to EXR and PNG");
  struct RenderArguments {
    std::string scene;
    std::string preset;
    std::string environment;
    bool watch = false;
    RenderOptions options;
  };
  const auto arguments = std::make_shared<RenderArguments>();
  command
      ->add_option("SCENE", arguments->scene,
                   "Scene file (.json) or model (.gltf, .glb, .obj, .ply)")
      ->required();
  command
      ->add_option("--preset", arguments->preset,
                   "textbook: the picture of the founding lesson that SCENE resembles, made by the "
                   "lesson's own program, faults and all. SCENE only chooses between its two "
                   "pictures: numbers, camera and lights are the lesson's, and so is the size "
                   "(400x200, 600x400) unless --size is given. The EXR file holds its float image, "
                   "display-referred; the PNG file its codes, x * 255 truncated. See nacre explain "
                   "textbook")
      ->check(CLI::IsMember({"textbook"}));
  command
      ->add_option("--environment", arguments->environment,
                   "Light the scene by this image of its surroundings instead of its own lights "
                   "(latitude and longitude, EXR or HDR); --set /lights/environment/rotate_deg=90 "
                   "turns it")
      ->type_name("FILE")
      ->group("Picture");
  command
      ->add_flag("--watch", arguments->watch,
                 "Render again whenever the scene, its textures or models change on disk, until "
                 "Ctrl-C. A file that is wrong is reported in one line, and the old picture stays")
      ->group("Picture");
  AddRenderOptions(command, &arguments->options);
  MoveBehindHelpAll(command, {"--preset"});
  command->footer(
      "Examples:\n"
      "  nacre render scenes/material_grid.json -o grid.exr -o grid.png --labels\n"
      "  nacre render scenes/phong_vs_pbr.json -o half.png --spp 64 --set /image/width=800\n"
      "  nacre render scene.json -o all.exr --layers all --depth float --explain\n"
      "  nacre render scene.json -o top.exr --tile 0/2 && nacre render scene.json -o low.exr "
      "--tile "
      "1/2\n"
      "  nacre merge -o all.exr top.exr low.exr\n"
      "  nacre render scene.json -o look.png --watch\n"
      "  nacre render scenes/phong_vs_pbr.json --preset textbook -o lesson.exr -o lesson.png");
  command->callback([arguments, command, exit_code] {
    if (!arguments->preset.empty()) {
      RunTextbookJob(arguments->options, arguments->scene, *command);
      return;
    }
    if (arguments->watch) {
      *exit_code = RunWatchJob(arguments->options, arguments->scene, arguments->environment);
      return;
    }
    RunRenderJob(arguments->options, {arguments->scene}, [&](LoadOptions load) {
      load.environment = arguments->environment;
      return LoadScene(arguments->scene, load);
    });
  });
}

}  // namespace nacre
