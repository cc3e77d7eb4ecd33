// SPDX-License-Identifier: Apache-2.0
#include "lesson/preset.h"

#include <array>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "base/error.h"
#include "base/path.h"
#include "base/version.h"
#include "image_io/png_writer.h"

namespace nacre {
namespace {

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

// Whether the scene has metallic-roughness spheres in at least two rows and two columns.
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
  // A warning not to take it for linear radiance, which the lesson does not have.
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

}  // namespace

TextbookSubject ChooseTextbookSubject(const Scene& scene, const std::string& file) {
  if (scene.meshes.empty() && IsComparison(scene)) return TextbookSubject::kComparison;
  if (scene.meshes.empty() && IsGrid(scene)) return TextbookSubject::kGrid;
  throw Error(ExitCode::kUsage, file, "the textbook preset has no picture of this scene",
              "it has two: one sphere split into a Phong and a metallic_roughness material, as "
              "scenes/phong_vs_pbr.json, and a grid of metallic_roughness spheres, as "
              "scenes/material_grid.json");
}

TextbookPicture RenderTextbookSubject(TextbookSubject subject, int width, int height) {
  const auto render = [&](auto settings, auto render_it) {
    if (width > 0) settings.width = width;
    if (height > 0) settings.height = height;
    return render_it(settings);
  };
  if (subject == TextbookSubject::kGrid) return render(TextbookGrid(), RenderTextbookGrid);
  return render(TextbookComparison(), RenderTextbookComparison);
}

void WriteTextbookFiles(const TextbookPicture& picture, const std::vector<std::string>& paths,
                        PixelType type, const ExrOptions& options,
                        const std::function<void()>& before_they_appear) {
  const PngHeader png_header{picture.width,
                             picture.height,
                             {{"Software", fmt::format("nacre {}", kVersion)},
                              {"nacre:preset", "textbook"},
                              {"nacre:settings", SettingsText(picture)}}};
  std::vector<std::unique_ptr<ExrWriter>> exr;
  std::vector<std::unique_ptr<PngWriter>> png;
  for (const std::string& path : paths) {
    if (HasExtension(path, ".exr")) {
      exr.push_back(std::make_unique<ExrWriter>(path, MakeHeader(picture, type), options));
    } else {
      png.push_back(std::make_unique<PngWriter>(
          path, png_header,
          PngOptions{.small = options.small, .reproducible = options.reproducible}));
    }
  }
  for (const auto& file : exr) WriteExr(picture, file.get());
  const std::vector<uint8_t> codes = TextbookCodes(picture, TextbookFaults());
  for (const auto& file : png) file->WriteAll(codes);
  before_they_appear();
  for (const auto& file : exr) file->Finish();
  for (const auto& file : png) file->Finish();
}

}  // namespace nacre
