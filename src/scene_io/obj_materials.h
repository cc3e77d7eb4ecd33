// SPDX-License-Identifier: Apache-2.0
// scene_io/obj_materials.h: material libraries (MTL) of Wavefront OBJ files.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include <tiny_obj_loader.h>

#include "scene/scene.h"
#include "scene_io/load_scene.h"
#include "scene_io/texture_image.h"

namespace nacre {

// Reads the libraries that an OBJ file names, from its folder.
class MtlReader : public tinyobj::MaterialReader {
 public:
  MtlReader(const std::filesystem::path& obj, const LoadOptions& options);

  // Called by tinyobjloader. A library that is missing is told, and one outside the folder or with
  // numbers that are none throws Error (kBadInput).
  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* numbers, std::string* warning,
                  std::string* error) override;

  // One for each, by the same number, with unique names: Blinn-Phong in the classic reading, as the
  // format defines it (its H is the bisector of L and V). After them the one of faces without any.
  // Textures and images go to the scene.
  std::vector<Material> MakeMaterials(const std::vector<tinyobj::material_t>& sources,
                                      Scene* scene);

 private:
  void Warn(const std::string& text);
  Material MakeMaterial(const tinyobj::material_t& source, Scene* scene);
  void AddMaps(const tinyobj::material_t& source, Scene* scene, Material* material);
  TextureId AddTexture(const std::string& name, const tinyobj::texture_option_t& options,
                       TextureEncoding encoding, Scene* scene);

  std::filesystem::path folder_;
  std::string file_;
  const LoadOptions& options_;
  std::unordered_set<std::string> told_, libraries_;
  std::map<std::pair<std::string, TextureEncoding>, ImageId> images_;  // by name
};

// What models without any material are made of: a light grey that is neither matt nor glossy.
Material MakeClay();

}  // namespace nacre
