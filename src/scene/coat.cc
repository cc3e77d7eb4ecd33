// SPDX-License-Identifier: Apache-2.0
#include "scene/coat.h"

#include <variant>

#include "brdf/fresnel.h"

namespace nacre {

std::optional<Material> CoatOf(const Material& material) {
  const auto* below = std::get_if<MetallicRoughnessMaterial>(&material.model);
  if (below == nullptr || below->coat == 0) return std::nullopt;
  MetallicRoughnessMaterial model;
  model.base_color = Rgb(0, 0, 0);
  model.dielectric_f0 = Rgb(FresnelF0(below->coat_ior, 0.0));
  model.specular = below->coat;
  model.specular_map = below->coat_map;
  model.roughness = below->coat_roughness;
  model.metallic_roughness_map = below->coat_roughness_map;
  model.shadowing = below->shadowing;
  // Light that the coat's microfacets block after one bounce enters it at the next one, mostly:
  // what the coat does not reflect at once is what is below it gets.
  model.compensation = Compensation::kNone;
  Material coat;
  coat.name = material.name;
  coat.model = model;
  coat.normal_map = below->coat_normal_map;
  return coat;
}

}  // namespace nacre
