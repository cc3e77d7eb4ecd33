// SPDX-License-Identifier: Apache-2.0
#include "scene/coat.h"

#include <algorithm>
#include <string>
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

std::vector<Coat> CoatsOf(const std::string& name, const MetallicRoughnessMaterial& below) {
  if (below.coat == 0 || below.coat_ior == 1) return {};
  MetallicRoughnessMaterial model;
  model.base_color = Rgb(0, 0, 0);
  const double f0 = FresnelF0(below.coat_ior, 0.0);
  const double f90 = GrazingReflectance(below.coat_ior, f0);
  model.dielectric_f0 = Rgb(f0 / f90);
  model.specular = f90 * below.coat;
  model.specular_map = below.coat_map;
  model.roughness = below.coat_roughness;
  model.metallic_roughness_map = below.coat_roughness_map;
  model.shadowing = below.shadowing;
  // Most of the light that the coat's microfacets block after one bounce is transmitted at the next
  // bounce, so the layers below get all that the coat does not reflect in one bounce.
  model.compensation = Compensation::kNone;
  return {{.material = {.name = name, .model = model, .normal_map = below.coat_normal_map},
           .roughness = "coat_roughness"}};
}

// A coat of the index of air is invisible, but its medium may absorb.
std::vector<Coat> CoatsOf(const std::string& name, const OpenPbrMaterial& below) {
  if (below.coat_weight == 0) return {};
  OpenPbrMaterial model;
  model.options.specular_weight_rule = SpecularWeightRule::kFactor;
  model.options.smith = below.options.smith;
  model.options.compensation = Compensation::kNone;
  model.base_weight = 0;
  model.specular_weight = below.coat_weight;
  model.specular_ior = below.coat_ior;
  model.specular_roughness = CoatRoughnessOf(below);
  model.specular_roughness_anisotropy = below.coat_roughness_anisotropy;
  model.options.alpha_max = below.options.alpha_max;
  model.geometry_tangent_deg = below.geometry_coat_tangent_deg;
  return {{.material = {.name = name, .model = model},
           .color = below.coat_color,
           .roughness = "coat_roughness"}};
}

template <class Model>
std::vector<Coat> CoatsOf(const std::string&, const Model&) {
  return {};
}

}  // namespace

std::vector<Coat> CoatsOf(const Material& material) {
  return std::visit([&](const auto& model) { return CoatsOf(material.name, model); },
                    material.model);
}

double StrengthOf(const Material& coat) {
  if (const auto* open_pbr = std::get_if<OpenPbrMaterial>(&coat.model)) {
    return open_pbr->specular_weight;
  }
  return std::get<MetallicRoughnessMaterial>(coat.model).specular;
}

bool RemoveCoats(Material* material) {
  const bool had = !CoatsOf(*material).empty();
  if (auto* model = std::get_if<MetallicRoughnessMaterial>(&material->model)) model->coat = 0;
  if (auto* model = std::get_if<OpenPbrMaterial>(&material->model)) model->coat_weight = 0;
  return had;
}

}  // namespace nacre
