// SPDX-License-Identifier: Apache-2.0
#include "scene/coat.h"

#include <algorithm>
#include <variant>

#include "brdf/fresnel.h"

namespace nacre {
namespace {

// F90 of Schlick's curve: 1, as in KHR_materials_clearcoat, but at most the value with which the
// curve's average, F0 + (F90 - F0) / 21, equals that of Fresnel's equations. This limit matters
// below an index of 1.34 and falls to 0 at an index of 1: a coat with the index of air is
// invisible.
double GrazingReflectance(double ior, double f0) {
  // From an index of 1.5 on, Schlick's average is below Fresnel's even with F90 = 1; from 5 on it
  // is above, with any F90.
  if (ior >= 1.5) return 1;
  return std::min(f0 + 21 * (AverageDielectric(ior) - f0), 1.0);
}

}  // namespace

std::vector<Coat> CoatsOf(const Material& material) {
  const auto* below = std::get_if<MetallicRoughnessMaterial>(&material.model);
  if (below == nullptr || below->coat == 0 || below->coat_ior == 1) return {};
  MetallicRoughnessMaterial model;
  model.base_color = Rgb(0, 0, 0);
  const double f0 = FresnelF0(below->coat_ior, 0.0);
  const double f90 = GrazingReflectance(below->coat_ior, f0);
  model.dielectric_f0 = Rgb(f0 / f90);
  model.specular = f90 * below->coat;
  model.specular_map = below->coat_map;
  model.roughness = below->coat_roughness;
  model.metallic_roughness_map = below->coat_roughness_map;
  model.shadowing = below->shadowing;
  // Most of the light that the coat's microfacets block after one bounce is transmitted at the next
  // bounce, so the layers below get all that the coat does not reflect in one bounce.
  model.compensation = Compensation::kNone;
  return {{Material{.name = material.name, .model = model, .normal_map = below->coat_normal_map},
           Rgb(1), "coat_roughness"}};
}

bool RemoveCoats(Material* material) {
  const bool had = !CoatsOf(*material).empty();
  if (auto* model = std::get_if<MetallicRoughnessMaterial>(&material->model)) model->coat = 0;
  return had;
}

}  // namespace nacre
