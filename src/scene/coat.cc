// SPDX-License-Identifier: Apache-2.0
#include "scene/coat.h"

#include <algorithm>
#include <variant>

#include "brdf/fresnel.h"
#include "brdf/fresnel_average.h"

namespace nacre {
namespace {

// What Schlick's curve reaches at grazing incidence: 1, as in KHR_materials_clearcoat, but no more
// than gives it the average of Fresnel's equations, which is F0 + (F90 - F0) / 21 of Schlick's.
// From an index of 1.34 down to 1 it falls to 0: a coat of the index of air is not seen.
double GrazingReflectance(double ior, double f0) {
  if (ior >= 1.5) return 1;  // Schlick's average is below, and from 5 on above whatever F90 is
  return std::min(f0 + 21 * (AverageDielectric(ior) - f0), 1.0);
}

}  // namespace

std::optional<Material> CoatOf(const Material& material) {
  const auto* below = std::get_if<MetallicRoughnessMaterial>(&material.model);
  if (below == nullptr || below->coat == 0 || below->coat_ior == 1) return std::nullopt;
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
