// SPDX-License-Identifier: Apache-2.0
#include "cli/textbook_job.h"

#include <algorithm>
#include <array>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "base/error.h"
#include "base/path.h"
#include "base/version.h"
#include "cli/given_options.h"
#include "cli/outputs.h"
#include "cli/print.h"
#include "cli/progress.h"
#include "image_io/exr_writer.h"
#include "image_io/png_writer.h"
#include "scene_io/load_scene.h"

namespace nacre {
namespace {

// Options that mean the same with the preset. All others speak of the renderer's samples, kernels,
// layers or tone operators, none of which the lesson has.
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

template <class Model>
bool Is(const Scene& scene, MaterialId material) {
  return material.valid() && std::holds_alternative<Model>(scene.materials[material.index].model);
}

bool IsComparison(const Scene& scene) {
  if (scene.spheres.size() != 1 || !Is<SplitMaterial>(scene, scene.spheres[0].material)) {
    return false;
  }
  const auto& split =
      std::get<SplitMaterial>(scene.materials[scene.spheres[0].material.index].model);
  return split.materials.size() == 2 && Is<PhongMaterial>(scene, split.materials[0]) &&
         Is<MetallicRoughnessMaterial>(scene, split.materials[1]);
}

// Metallic-roughness spheres in rows and columns, at least two of each.
bool IsGrid(const Scene& scene) {
  std::set<double> columns;
  std::set<double> rows;
  for (const Sphere& sphere : scene.spheres) {
    if (!Is<MetallicRoughnessMaterial>(scene, sphere.material)) return false;
    columns.insert(sphere.center.x);
    rows.insert(sphere.center.y);
  }
  return columns.size() >= 2 && rows.size() >= 2 &&
         columns.size() * rows.size() == scene.spheres.size();
}

// The lesson's size unless `size` says another. Unlike the renderer, the lesson holds all of its
// picture at once.
void ChooseSize(const std::string& size, int* width, int* height) {
  if (size.empty()) return;
  ParseSize(size, width, height);
  constexpr int64_t kMaxPixels = int64_t{8192} * 8192;
  if (int64_t{*width} * *height <= kMaxPixels) return;
  throw Error(ExitCode::kUsage, "--size", "\"" + size + "\" is too large for --preset textbook",
              "it holds the whole picture in memory: at most 8192x8192 pixels");
}

TextbookPicture RenderSubject(TextbookSubject subject, const std::string& size) {
  if (subject == TextbookSubject::kComparison) {
    TextbookComparison comparison;
    ChooseSize(size, &comparison.width, &comparison.height);
    return RenderTextbookComparison(comparison);
  }
  TextbookGrid grid;
  ChooseSize(size, &grid.width, &grid.height);
  return RenderTextbookGrid(grid);
}

std::string SettingsText(const TextbookPicture& picture) {
  return fmt::format("size={}x{} textbook faults=all", picture.width, picture.height);
}

ExrHeader MakeHeader(const TextbookPicture& picture, PixelType type) {
  ExrHeader header;
  header.display = header.data = Window{0, 0, picture.width, picture.height};
  for (const char* name : {"R", "G", "B"}) header.channels.push_back({name, type});
  auto& attributes = header.attributes;
  attributes["Software"] = fmt::format("nacre {}", kVersion);
  attributes["nacre:version"] = std::string(kVersion);
  attributes["nacre:commit"] = std::string(kCommit);
  attributes["nacre:preset"] = std::string("textbook");
  attributes["nacre:settings"] = SettingsText(picture);
  // So that nobody takes it for linear radiance, which the lesson does not have.
  attributes["comments"] = std::string(
      "display-referred: the textbook preset tone-maps and encodes in the shading, as the lesson");
  return header;
}

void WriteExr(const TextbookPicture& picture, ExrWriter* exr) {
  std::array<std::vector<float>, 3> planes;
  for (int c = 0; c < 3; ++c) {
    std::vector<float>& plane = planes[static_cast<size_t>(c)];
    plane.reserve(picture.pixel_count());
    for (const Rgb& color : picture.film) plane.push_back(static_cast<float>(color[c]));
  }
  exr->WriteAll({planes[0].data(), planes[1].data(), planes[2].data()});
}

// All files are open before any is written, and complete before any gets its name.
void WriteOutputs(const TextbookPicture& picture, const RenderOptions& options, PixelType type) {
  const ExrOptions exr_options{.compression = ParseCompression(options.compression),
                               .small = options.small,
                               .reproducible = options.reproducible};
  const PngHeader png_header{picture.width,
                             picture.height,
                             {{"Software", fmt::format("nacre {}", kVersion)},
                              {"nacre:preset", "textbook"},
                              {"nacre:settings", SettingsText(picture)}}};
  std::vector<std::unique_ptr<ExrWriter>> exr;
  std::vector<std::unique_ptr<PngWriter>> png;
  for (const std::string& path : options.outputs) {
    if (HasExtension(path, ".exr")) {
      exr.push_back(std::make_unique<ExrWriter>(path, MakeHeader(picture, type), exr_options));
    } else {
      png.push_back(std::make_unique<PngWriter>(
          path, png_header,
          PngOptions{.small = options.small, .reproducible = options.reproducible}));
    }
  }
  for (const auto& file : exr) WriteExr(picture, file.get());
  const std::vector<uint8_t> codes = TextbookCodes(picture, TextbookFaults());
  for (const auto& file : png) file->WriteAll(codes);
  ThrowIfStopped();
  for (const auto& file : exr) file->Finish();
  for (const auto& file : png) file->Finish();
}

}  // namespace

TextbookSubject ChooseTextbookSubject(const Scene& scene, const std::string& file) {
  if (scene.meshes.empty() && IsComparison(scene)) return TextbookSubject::kComparison;
  if (scene.meshes.empty() && IsGrid(scene)) return TextbookSubject::kGrid;
  throw Error(ExitCode::kUsage, file, "the textbook preset has no picture of this scene",
              "it has two: one sphere split into a Phong and a metallic_roughness material, as "
              "scenes/phong_vs_pbr.json, and a grid of metallic_roughness spheres, as "
              "scenes/material_grid.json");
}

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
  const TextbookPicture picture = RenderSubject(subject, options.size);
  ThrowIfStopped();
  // Half would be off by more than the lesson's float image allows; only who asks for it gets it.
  const bool half = command.count("--depth") > 0 && options.depth == "half";
  WriteOutputs(picture, options, half ? PixelType::kHalf : PixelType::kFloat);
  if (options.quiet) return;
  for (const std::string& output : options.outputs) {
    PrintError("{}: {}x{}, the lesson's {}\n", output, picture.width, picture.height,
               subject == TextbookSubject::kComparison ? "Phong beside PBR" : "material grid");
  }
}

}  // namespace nacre
