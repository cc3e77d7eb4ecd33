// SPDX-License-Identifier: Apache-2.0
#include "cli/textbook_job.h"

#include <set>

#include <fmt/format.h>

#include "base/error.h"
#include "cli/given_options.h"
#include "cli/outputs.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "lesson/preset.h"
#include "scene_io/load_scene.h"

namespace nacre {
namespace {

// Options that have the same meaning with the preset. The others are about the renderer's samples,
// kernels, layers or tone operators, which the lesson does not have.
const std::set<std::string> kApplying = {"SCENE",   "--preset",      "--output", "--size",
                                         "--depth", "--compression", "--small",  "--reproducible",
                                         "--quiet", "--allow-paths"};

void RefuseOptionsThatCannotApply(const CLI::App& command) {
  RefuseOptions(
      command, [](const CLI::Option& option) { return kApplying.contains(option.get_name()); },
      "--preset textbook",
      "the preset is the lesson's own program, numbers and curves included; leave it out, or "
      "render "
      "without the preset");
}

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

}  // namespace

void RunTextbookJob(const RenderOptions& options, const std::string& path,
                    const CLI::App& command) {
  RefuseOptionsThatCannotApply(command);
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

}  // namespace nacre
