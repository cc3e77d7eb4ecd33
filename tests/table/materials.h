// SPDX-License-Identifier: Apache-2.0
// tests/table/materials.h: materials that tables are made of.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "scene/material.h"

namespace nacre {

// Every layer, lobe and colour of OpenPBR, all numbers off their defaults.
inline Material FullOpenPbr() {
  return {.model = OpenPbrMaterial{.base_weight = 0.9,
                                   .base_color = {0.7, 0.4, 0.2},
                                   .base_diffuse_roughness = 0.3,
                                   .base_metalness = 0.4,
                                   .specular_weight = 0.8,
                                   .specular_color = {0.9, 0.7, 0.5},
                                   .specular_roughness = 0.35,
                                   .specular_ior = 1.6,
                                   .coat_weight = 0.7,
                                   .coat_color = {0.9, 0.6, 0.4},
                                   .coat_roughness = 0.25,
                                   .coat_ior = 1.45,
                                   .coat_darkening = 0.8,
                                   .fuzz_weight = 0.3,
                                   .fuzz_color = {0.3, 0.5, 0.8},
                                   .fuzz_roughness = 0.6}};
}

// A plastic of OpenPBR: a dielectric over a diffuse base.
inline Material PlasticOpenPbr() {
  return {.model = OpenPbrMaterial{.base_color = {0.7, 0.4, 0.2},
                                   .specular_color = {0.9, 0.7, 0.5},
                                   .specular_roughness = 0.4}};
}

// A brushed metal under a brushed coat, turned against each other and against the surface's
// tangent.
inline Material BrushedOpenPbr() {
  return {.model = OpenPbrMaterial{.base_color = {0.9, 0.7, 0.3},
                                   .base_metalness = 0.8,
                                   .specular_roughness = 0.4,
                                   .specular_roughness_anisotropy = 0.7,
                                   .coat_weight = 0.6,
                                   .coat_color = {0.9, 0.8, 0.7},
                                   .coat_roughness = 0.3,
                                   .coat_roughness_anisotropy = 0.5,
                                   .geometry_tangent_deg = 25,
                                   .geometry_coat_tangent_deg = -40}};
}

inline Material RoughGold() {
  return {.model = MetallicRoughnessMaterial{
              .base_color = {0.9, 0.7, 0.3}, .metallic = 1, .roughness = 0.6}};
}

// A folder of its own, which vanishes with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "nacre_table_XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string Write(const std::string& name, const std::string& bytes) const {
    const std::string path = (path_ / name).string();
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  std::string Path(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace nacre
