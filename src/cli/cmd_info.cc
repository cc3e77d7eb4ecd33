// SPDX-License-Identifier: Apache-2.0
// cli/cmd_info.cc: nacre info: what an image file or scene file holds, and what this build is.
#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "api/metadata.h"
#include "base/parallel.h"
#include "base/path.h"
#include "base/target.h"
#include "base/version.h"
#include "cli/commands.h"
#include "cli/print.h"
#include "image_io/exr_reader.h"
#include "image_io/image_reader.h"
#include "image_io/verify_image.h"
#include "scene/hash.h"
#include "scene_io/load_scene.h"

namespace nacre {
namespace {

std::string TypeName(PixelType type) {
  switch (type) {
    case PixelType::kHalf:
      return "half";
    case PixelType::kFloat:
      return "float";
    case PixelType::kUint:
      return "uint";
  }
  return {};
}

std::string WindowText(const Window& w) {
  return fmt::format("{}x{} at {},{}", w.width(), w.height(), w.x0, w.y0);
}

void PrintImage(const std::string& path) {
  const Image image = HasExtension(path, ".exr") ? ReadExrHeader(path) : ReadImage(path);
  PrintOut("{}\n", path);
  PrintOut("  display window  {}\n", WindowText(image.display));
  PrintOut("  data window     {}\n", WindowText(image.data));
  std::vector<std::string> channels;
  for (const Channel& channel : image.channels) {
    channels.push_back(channel.name + ":" + TypeName(channel.type));
  }
  PrintOut("  channels        {}\n", fmt::format("{}", fmt::join(channels, " ")));
  for (const auto& [name, value] : image.metadata) PrintOut("  {:<15} {}\n", name, value);
}

// "3: gold, silver, copper", as --set names them; of many, some.
template <class Item>
std::string CountAndNames(const std::vector<Item>& items) {
  constexpr size_t kMost = 8;
  std::vector<std::string> names;
  names.reserve(kMost + 1);
  for (const Item& item : items) {
    if (names.size() < kMost) names.push_back(item.name);
  }
  if (items.size() > kMost) names.emplace_back("...");
  return fmt::format("{}{}{}", items.size(), names.empty() ? "" : ": ", fmt::join(names, ", "));
}

void PrintScene(const std::string& path, bool allow_paths) {
  const Scene scene = LoadScene(path, {.overrides = {}, .allow_paths = allow_paths});
  size_t triangles = 0;
  for (const Mesh& mesh : scene.meshes) triangles += mesh.triangles.size() / 3;
  PrintOut("{}\n", path);
  PrintOut("  image       {}x{}, {} sample{} a pixel\n", scene.image.width, scene.image.height,
           scene.image.spp, scene.image.spp == 1 ? "" : "s");
  PrintOut("  spheres     {}\n", scene.spheres.size());
  PrintOut("  meshes      {} with {} triangles\n", scene.meshes.size(), triangles);
  PrintOut("  materials   {}\n", CountAndNames(scene.materials));
  PrintOut("  lights      {}\n", CountAndNames(scene.lights));
  PrintOut("  shadowing   {}\n", ShadowingForms(scene));
  PrintOut("  hash        {:016x}\n", HashScene(scene));
}

void PrintBuild() {
  std::vector<std::string> targets;
  for (const Target target : SupportedTargets()) targets.push_back(TargetName(target));
  PrintOut("nacre {} ({})\n", kVersion, kCommit);
  PrintOut("  SIMD targets here  {}\n", fmt::format("{}", fmt::join(targets, ", ")));
  PrintOut("  threads            {}\n", ThreadCount(0));
}

}  // namespace

void AddInfoCommand(CLI::App* app, int*) {
  CLI::App* command =
      app->add_subcommand("info", "Show what image and scene files hold; alone, about this build");
  struct InfoArguments {
    std::vector<std::string> files;
    bool allow_paths = false;
    bool verify = false;
  };
  const auto arguments = std::make_shared<InfoArguments>();
  command->add_option(
      "FILE", arguments->files,
      "Images (EXR, PNG, ...), scenes (.json) and models (.gltf, .glb, .obj, .ply)");
  command->add_flag("--allow-paths", arguments->allow_paths,
                    "Let scenes refer to files outside their own folder");
  command->add_flag("--verify", arguments->verify,
                    "Read and decode all of each image and compare its checksums: 65 if one is not "
                    "whole. EXR files of nacre have one in their header");
  command->footer(
      "Examples:\n"
      "  nacre info render.exr\n"
      "  nacre info --verify render.exr render.png\n"
      "  nacre info scenes/first_scene.json");
  command->callback([arguments] {
    if (arguments->files.empty()) PrintBuild();
    for (const std::string& file : arguments->files) {
      if (HasExtension(file, ".json") || IsModelFile(file)) {
        PrintScene(file, arguments->allow_paths);
      } else {
        PrintImage(file);
        if (arguments->verify) PrintOut("  {:<15} {}\n", "verified", VerifyImage(file));
      }
    }
  });
}

}  // namespace nacre
