// SPDX-License-Identifier: Apache-2.0
// cli/cmd_render.cc: nacre render SCENE -o FILE...
#include <memory>
#include <set>

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "cli/commands.h"
#include "cli/help_text.h"
#include "cli/outputs.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "cli/render_job.h"
#include "cli/usage_error.h"
#include "lesson/preset.h"
#include "scene_io/load_scene.h"

namespace nacre {
namespace {

// Options that have the same meaning with the preset. The others are about the renderer's samples,
// kernels, layers or tone operators, which the lesson does not have.
const std::set<std::string> kApplying = {"SCENE",   "--preset",      "--output", "--size",
                                         "--depth", "--compression", "--small",  "--reproducible",
                                         "--quiet", "--allow-paths"};

// Sets both sides to 0 if no size is given. Unlike the renderer, the lesson keeps the whole picture
// in memory.
void ChooseSize(const std::string& size, int* width, int* height) {
  if (size.empty()) return;
  ParseSize(size, width, height);
  constexpr int64_t kMaxPixels = int64_t{8192} * 8192;
  if (int64_t{*width} * *height <= kMaxPixels) return;
  throw Error(ExitCode::kUsage, "--size", "\"" + size + "\" is too large for --preset textbook",
              "it holds the whole picture in memory: at most 8192x8192 pixels");
}

// nacre render --preset textbook: renders the picture that the scene at `path` selects, by the
// lesson's own program.
void RunTextbookJob(const RenderOptions& options, const std::string& path,
                    const CLI::App& command) {
  RefuseOptions(
      command, [](const CLI::Option& option) { return kApplying.contains(option.get_name()); },
      "--preset textbook",
      "the preset is the lesson's own program, numbers and curves included; leave it out, or "
      "render without the preset");
  CheckPicturePaths(options.outputs);
  CheckPathsDiffer(options.outputs);
  std::vector<std::string> read = {path};
  CheckOutputsAreNoInputs(options.outputs, read);
  LoadOptions load;
  load.allow_paths = options.allow_paths;
  load.on_file = [&](const std::filesystem::path& file) { read.push_back(file.string()); };
  const TextbookSubject subject = ChooseTextbookSubject(LoadScene(path, load), path);
  CheckOutputsAreNoInputs(options.outputs, read);
  ThrowIfStopped();
  int width = 0, height = 0;
  ChooseSize(options.size, &width, &height);
  const TextbookPicture picture = RenderTextbookSubject(subject, width, height);
  ThrowIfStopped();
  // Half precision would exceed the error of the lesson's float image, so it is used only on
  // request.
  const bool half = command.count("--depth") > 0 && options.depth == "half";
  WriteTextbookFiles(picture, options.outputs, half ? PixelType::kHalf : PixelType::kFloat,
                     {.compression = ParseCompression(options.compression),
                      .small = options.small,
                      .reproducible = options.reproducible},
                     ThrowIfStopped);
  if (options.quiet) return;
  for (const std::string& output : options.outputs) {
    PrintError("{}: {}x{}, the lesson's {}\n", output, picture.width, picture.height,
               subject == TextbookSubject::kComparison ? "Phong beside PBR" : "material grid");
  }
}

}  // namespace

void AddRenderCommand(CLI::App* app, int* exit_code) {
  CLI::App* command =
      app->add_subcommand("render", "Render a scene file or a model to EXR and PNG");
  struct RenderArguments {
    std::string scene;
    std::string preset;
    std::string environment;
    std::optional<std::string> variant;
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
      ->add_option(
          "--environment", arguments->environment,
          "Light the scene by this image (latitude and longitude, EXR or HDR) instead of by "
          "its lights; --set /lights/environment/rotate_deg=90 turns it")
      ->type_name("FILE")
      ->group("Picture");
  command
      ->add_option("--variant", arguments->variant,
                   "Show a glTF model in this variant of its materials; `nacre info` lists them")
      ->type_name("NAME")
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
      "--tile 1/2\n"
      "  nacre merge -o all.exr top.exr low.exr\n"
      "  nacre render scene.json -o look.png --watch\n"
      "  nacre render scenes/phong_vs_pbr.json --preset textbook -o lesson.exr -o lesson.png");
  command->callback([arguments, command, exit_code] {
    if (!arguments->preset.empty()) {
      RunTextbookJob(arguments->options, arguments->scene, *command);
      return;
    }
    if (arguments->watch) {
      *exit_code = RunWatchJob(arguments->options, arguments->scene, arguments->environment,
                               arguments->variant);
      return;
    }
    RunRenderJob(arguments->options, {arguments->scene}, [&](LoadOptions load) {
      load.environment = arguments->environment;
      load.variant = arguments->variant;
      return LoadScene(arguments->scene, load);
    });
  });
}

}  // namespace nacre
