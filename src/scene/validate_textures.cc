// SPDX-License-Identifier: Apache-2.0
// scene/validate_textures.cc: the part of Validate() that checks images, textures and the maps of
// materials.
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/material_parameters.h"
#include "scene/validate.h"
#include "scene/validate_numbers.h"

namespace nacre {
namespace {

void ValidateTexture(const Scene& scene, const Texture& texture, const std::string& where,
                     FaultList* faults) {
  if (texture.image.index >= scene.images.size()) {
    faults->Add(where, "no image", "set the handle of one of the scene's images");
  } else if (scene.images[texture.image.index].texels == nullptr) {
    faults->Add(where, "its image holds nothing", "read the image first");
  }
  CheckDirection(texture.axis, where + "/mapping/axis", faults);
  CheckNumber(texture.rotate_deg, limits::kAngleDeg, where + "/mapping/rotate_deg", faults);
  CheckPoint(texture.center, where + "/mapping/center", faults);
  CheckNumber(texture.size, limits::kLength, where + "/mapping/size", faults);
  CheckNumber(texture.uv_rotate_deg, limits::kAngleDeg, where + "/rotate_deg", faults);
  for (const double component : {texture.scale.x, texture.scale.y}) {
    CheckNumber(component, limits::kTextureScale, where + "/scale", faults);
  }
  for (const double component : {texture.offset.x, texture.offset.y}) {
    CheckNumber(component, limits::kTextureScale, where + "/offset", faults);
  }
}

using NamedMap = std::pair<std::string_view, TextureId>;

std::vector<NamedMap> MapsOf(const Material& material) {
  std::vector<NamedMap> maps = {{"bump_map", material.bump_map.texture}};
  if (const MaterialModel* const model = ModelOf(material)) {
    for (const MaterialNormalMap& row : model->normal_maps) {
      maps.emplace_back(row.name, NormalMapOf(row, material).texture);
    }
    for (const MaterialMap& map : model->maps) maps.emplace_back(map.name, map.get(material));
  }
  return maps;
}

// A mesh without texture coordinates needs a mapping that makes them.
void ValidateCoordinates(const Scene& scene, const Material& material, const std::string& where,
                         FaultList* faults) {
  for (const auto& [name, id] : MapsOf(material)) {
    if (!id.valid() || id.index >= scene.textures.size()) continue;
    const Texture& texture = scene.textures[id.index];
    if (texture.mapping != MappingKind::kUv) continue;
    faults->Add(where,
                fmt::format("the mesh has no texture coordinates for texture \"{}\"", texture.name),
                "give the texture a \"mapping\": spherical, cylindrical, planar or cube");
    return;
  }
}

}  // namespace

void ValidateMaps(const Scene& scene, const Material& material, const std::string& where,
                  FaultList* faults) {
  for (const auto& [name, id] : MapsOf(material)) {
    if (!id.valid() || id.index < scene.textures.size()) continue;
    faults->Add(where + "/" + std::string(name), fmt::format("there is no texture {}", id.index),
                fmt::format("the scene has {}", scene.textures.size()));
  }
  if (const MaterialModel* const model = ModelOf(material)) {
    for (const MaterialNormalMap& row : model->normal_maps) {
      CheckNumber(NormalMapOf(row, material).scale, limits::kNormalScale,
                  where + "/" + std::string(row.name) + "/scale", faults);
    }
  }
  CheckNumber(material.bump_map.distance, limits::kCoordinate, where + "/bump_map/distance",
              faults);
}

void ValidateTextures(const Scene& scene, FaultList* faults) {
  for (size_t i = 0; i < scene.textures.size(); ++i) {
    const std::string& name = scene.textures[i].name;
    ValidateTexture(scene, scene.textures[i],
                    "/textures/" + (name.empty() ? std::to_string(i) : PointerToken(name)), faults);
  }
  for (size_t i = 0; i < scene.meshes.size(); ++i) ValidateMaterialOfMesh(scene, i, faults);
}

void ValidateMaterialOfMesh(const Scene& scene, size_t index, FaultList* faults) {
  const Mesh& mesh = scene.meshes[index];
  if (!mesh.uvs.empty() || mesh.material.index >= scene.materials.size()) return;
  const Material& material = scene.materials[mesh.material.index];
  const std::string where = fmt::format("/meshes/{}", index);
  ValidateCoordinates(scene, material, where, faults);
  if (const auto* split = std::get_if<SplitMaterial>(&material.model)) {
    for (const MaterialId id : split->materials) {
      if (id.index >= scene.materials.size()) continue;
      ValidateCoordinates(scene, scene.materials[id.index], where, faults);
    }
  }
}

}  // namespace nacre
