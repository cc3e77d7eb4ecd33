// SPDX-License-Identifier: Apache-2.0
#include "scene/idle_layers.h"

#include <string>
#include <string_view>

#include "scene/material_parameters.h"

namespace nacre {
namespace {

bool IsBlack(const Scene& scene, TextureId id) {
  if (id.index >= scene.textures.size()) return false;
  const ImageId image = scene.textures[id.index].image;
  return image.index < scene.images.size() && scene.images[image.index].is_black;
}

// Removes the maps whose names begin with `prefix`. Returns whether the material had any.
bool RemoveMaps(const MaterialModel& model, std::string_view prefix, Material* material) {
  bool had = false;
  for (const MaterialMap& map : model.maps) {
    if (!map.name.starts_with(prefix) || !map.get(*material).valid()) continue;
    map.set(*material, {});
    had = true;
  }
  for (const MaterialNormalMap& map : model.normal_maps) {
    if (!map.name.starts_with(prefix) || !map.of(*material).texture.valid()) continue;
    map.of(*material) = {};
    had = true;
  }
  return had;
}

// Whether the parameter, or its map, is 0 all over. If it is the map, the parameter becomes 0.
bool LeavesNothing(const Scene& scene, const MaterialModel& model,
                   const MaterialParameter& parameter, Material* material) {
  const std::string name = std::string(parameter.name) + "_map";
  for (const MaterialMap& map : model.maps) {
    if (map.name == name && IsBlack(scene, map.get(*material))) parameter.set(*material, Rgb(0));
  }
  return nacre::IsBlack(parameter.get(*material));
}

}  // namespace

std::optional<Material> RemoveIdleLayers(const Scene& scene, Material* material) {
  const MaterialModel* const model = ModelOf(*material);
  if (model == nullptr) return std::nullopt;
  Material whole = *material;
  bool removed = false;
  for (const MaterialParameter& parameter : model->parameters) {
    if (parameter.layer.empty() || !LeavesNothing(scene, *model, parameter, material)) continue;
    removed = RemoveMaps(*model, std::string(parameter.layer) + "_", material) || removed;
  }
  if (!removed) return std::nullopt;
  return whole;
}

}  // namespace nacre
