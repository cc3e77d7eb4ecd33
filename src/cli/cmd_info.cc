// SPDX-License-Identifier: Apache-2.0
// cli/cmd_info.cc: nacre info: prints the contents of an image or scene file, and describes the
// build.
#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/parallel.h"
#include "base/path.h"
#include "base/target.h"
#include "base/version.h"
#include "cli/commands.h"
#include "cli/help_text.h"
#include "cli/print.h"
#include "cli/render_options.h"
#include "color/primaries.h"
#include "image_io/format_readers.h"
#include "image_io/read_image.h"
#include "output/metadata.h"
#include "scene/hash.h"
#include "scene/primitives.h"
#include "scene_io/load_scene.h"
#include "visibility/box_trees.h"

namespace nacre {
namespace {

std::string WindowText(const Window& w) {
  return fmt::format("{}x{} at {},{}", w.width(), w.height(), w.x0, w.y0);
}

void PrintPart(const ImagePart& part, const std::string& indent) {
  PrintOut("{}display window  {}\n", indent, WindowText(part.display));
  PrintOut("{}data window     {}\n", indent, WindowText(part.data));
  std::vector<std::string> channels;
  for (const ImagePart::PartChannel& channel : part.channels) {
    const bool sampled = channel.x_sampling != 1 || channel.y_sampling != 1;
    channels.push_back(
        channel.name + ":" + PixelTypeName(channel.type) +
        (sampled ? fmt::format("/{}x{}", channel.x_sampling, channel.y_sampling) : std::string()));
  }
  PrintOut("{}channels        {}\n", indent, fmt::format("{}", fmt::join(channels, " ")));
  if (!part.refusal.empty()) {
    PrintOut("{}not read        {}\n", indent, part.refusal);
  }
  for (const auto& [name, value] : part.metadata) {
    const bool is_none = name == "chromaticities" && !ParsePrimaries(value);
    PrintOut("{}{:<15} {}{}\n", indent, name, value,
             is_none ? " (none: Rec. 709's are taken)" : "");
  }
}

void PrintImage(const std::string& path, const std::string& wanted) {
  const std::vector<ImagePart> parts = DescribeImage(path);
  const auto is_wanted = [&](const ImagePart& part) {
    return wanted.empty() || part.name == wanted;
  };
  if (std::none_of(parts.begin(), parts.end(), is_wanted)) OpenImage(path, wanted);  // throws
  PrintOut("{}\n", path);
  for (size_t i = 0; i < parts.size(); ++i) {
    if (!is_wanted(parts[i])) continue;
    if (parts.size() > 1) {
      PrintOut("  part {} of {}: {}\n", i + 1, parts.size(), parts[i].name);
    }
    PrintPart(parts[i], parts.size() > 1 ? "    " : "  ");
  }
}

// The number of items and their names for --set, of which long lists are cut: "3: gold, silver,
// copper".
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

void PrintScene(const std::string& path, LoadOptions options) {
  std::vector<std::string> notes;  // what is not shown as the file has it, and its variants
  options.on_warning = [&](const std::string& text) { notes.push_back(text); };
  const Scene scene = LoadScene(path, options);
  PrintOut("{}\n", path);
  PrintOut("  image       {}x{}, {} sample{} a pixel\n", scene.image.width, scene.image.height,
           scene.image.spp, scene.image.spp == 1 ? "" : "s");
  PrintOut("  spheres     {}\n", scene.spheres.size());
  PrintOut("  meshes      {} with {} triangles\n", scene.meshes.size(), CountTriangles(scene));
  PrintOut("  materials   {}\n", CountAndNames(scene.materials));
  PrintOut("  lights      {}\n", CountAndNames(scene.lights));
  MaterialTraits traits = 0;
  for (const Material& material : scene.materials) traits |= ShadowingTrait(material);
  PrintOut("  shadowing   {}\n", ShadowingForms(traits));
  PrintOut("  hash        {:016x}\n", HashScene(scene));
  for (const std::string& note : notes) PrintError("note: {}\n", note);
}

void PrintBuild() {
  std::vector<std::string> targets;
  for (const Target target : SupportedTargets()) targets.push_back(TargetName(target));
  PrintOut("nacre {} ({})\n", kVersion, kCommit);
  PrintOut("  SIMD targets here  {}\n", fmt::format("{}", fmt::join(targets, ", ")));
  PrintOut("  threads            {}\n", ThreadCount(0));
  const char* const embree = EmbreeVersion();
  PrintOut("  Embree             {}\n", embree == nullptr ? "none: spheres only" : embree);
  PrintOut("  TIFF               {}\n", HasOiio() ? "by OpenImageIO" : "not read");
}

}  // namespace

void AddInfoCommand(CLI::App* app, int*) {
  CLI::App* command = app->add_subcommand(
      "info", "Show what images and scenes hold; without a file, about this build");
  struct InfoArguments {
    std::vector<std::string> files;
    std::string part;
    LoadOptions load;
    bool verify = false;
  };
  const auto arguments = std::make_shared<InfoArguments>();
  command->add_option(
      "FILE", arguments->files,
      "Images (EXR, PNG, ...), scenes (.json) and models (.gltf, .glb, .obj, .ply)");
  command->add_option("--part", arguments->part, "Part of EXR files that have several");
  command->add_flag("--allow-paths", arguments->load.allow_paths,
                    "Let scenes refer to files outside their own folder");
  AddMaxPrimitivesOption(command, &arguments->load.max_primitives);
  command->add_flag(
      "--verify", arguments->verify,
      "Decode each image completely and compare its checksums; exit code 65 if one is "
      "damaged. EXR files of nacre have a checksum in their header");
  MoveBehindHelpAll(command, {"--max-primitives"});
  command->footer(
      "Examples:\n"
      "  nacre info render.exr\n"
      "  nacre info --verify render.exr render.png\n"
      "  nacre info scenes/first_scene.json");
  command->callback([arguments] {
    if (arguments->files.empty()) PrintBuild();
    for (const std::string& file : arguments->files) {
      RefuseOtherModels(file);
      if (HasExtension(file, ".json") || IsModelFile(file)) {
        PrintScene(file, arguments->load);
      } else {
        PrintImage(file, arguments->part);
        if (arguments->verify) PrintOut("  {:<15} {}\n", "verified", VerifyImage(file));
      }
    }
  });
}

}  // namespace nacre
