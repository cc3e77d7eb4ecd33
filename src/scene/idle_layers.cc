// SPDX-License-Identifier: Apache-2.0
#include "scene/idle_layers.h"

#include <variant>

namespace nacre {

std::optional<Material> RemoveIdleLayers(const Scene& scene, Material* material) {
  const auto is_black = [&](TextureId id) {
    if (id.index >= scene.textures.size()) return false;
    const ImageId image = scene.textures[id.index].image;
    return image.index < scene.images.size() && scene.images[image.index].is_black;
  };
  auto* const model = std::get_if<MetallicRoughnessMaterial>(&material->model);
  const bool emission = (IsBlack(material->emission) || is_black(material->emission_map)) &&
                        (material->emission != Rgb(0) || material->emission_map.valid());
  const bool coat = model != nullptr && (model->coat == 0 || is_black(model->coat_map)) &&
                    (model->coat != 0 || model->coat_map.valid() ||
                     model->coat_roughness_map.valid() || model->coat_normal_map.texture.valid());
  const bool sheen = model != nullptr &&
                     (IsBlack(model->sheen_color) || model->sheen_roughness == 0 ||
                      is_black(model->sheen_color_map) || is_black(model->sheen_roughness_map)) &&
                     (model->sheen_color != Rgb(0) || model->sheen_color_map.valid() ||
                      model->sheen_roughness_map.valid());
  if (!emission && !coat && !sheen) return std::nullopt;
  Material whole = *material;
  if (emission) {
    material->emission = Rgb(0);
    material->emission_map = {};
  }
  if (coat) {
    model->coat = 0;
    model->coat_map = model->coat_roughness_map = {};
    model->coat_normal_map = {};
  }
  if (sheen) {
    model->sheen_color = Rgb(0);
    model->sheen_color_map = model->sheen_roughness_map = {};
  }
  return whole;
}

}  // namespace nacre
