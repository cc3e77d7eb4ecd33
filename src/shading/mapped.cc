// SPDX-License-Identifier: Apache-2.0
#include "shading/mapped.h"

#include <algorithm>
#include <variant>

#include "base/overloaded.h"
#include "shading/texture_kernels.h"

namespace nacre {
namespace {

using ByHit = const float*;

void Assign(const Soa3<float>& from, ByHit (&to)[3]) {
  to[0] = from.x.data();
  to[1] = from.y.data();
  to[2] = from.z.data();
}

template <class Test>
bool AnyOf(const AlignedArray<double>& numbers, const ShadeRange& range, const Test& test) {
  return std::any_of(numbers.data() + range.begin, numbers.data() + range.end, test);
}

void Shade(const LambertModel&, const ShadeRange& range, bool, NarrowLobes*, const HitTextures& t) {
  LambertLightOf<ByHit> light;
  Assign(t.by_diffuse, light.diffuse);
  ShadeLambertMaps(light, range);
}

void Shade(const RoughMatteModel& model, const ShadeRange& range, bool, NarrowLobes*,
           const HitTextures& t) {
  LambertLightOf<ByHit> light;
  Assign(t.by_diffuse, light.diffuse);
  RoughMatteUniformsOf<ByHit> uniforms{model.form, static_cast<float>(model.roughness), &light, {}};
  Assign(t.base_ratio, uniforms.ratio);
  ShadeRoughMatteMaps(uniforms, range);
}

void Shade(const PhongFamilyModel& phong, const ShadeRange& range, bool, NarrowLobes* scratch,
           const HitTextures& t) {
  PhongLightOf<ByHit> light;
  Assign(t.by_diffuse, light.diffuse);
  Assign(t.by_specular, light.specular);
  PhongUniformsOf<ByHit> uniforms{phong.model, t.alpha.data(), &light, nullptr};
  const auto is_narrow = [&](double n) { return n > kDoubleTermsShininess; };
  if (AnyOf(t.width, range, is_narrow)) {
    NarrowPhongMaps(phong.model, t.width.data(), range, scratch);
    uniforms.narrow = scratch;
  }
  ShadePhongMaps(uniforms, range);
}

void ShadeByCurve(const MicrofacetUniformsOf<ByHit>& uniforms, const ShadeRange& range) {
  switch (uniforms.model->fresnel) {
    case FresnelForm::kSchlick:
      return ShadeSchlickMaps(uniforms, range);
    case FresnelForm::kF82:
      return ShadeF82Maps(uniforms, range);
    case FresnelForm::kDielectric:
      return ShadeDielectricMaps(uniforms, range);
    case FresnelForm::kConductor:
      return ShadeConductorMaps(uniforms, range);
  }
}

void Shade(const MicrofacetModel& model, const ShadeRange& range, bool own_fits,
           NarrowLobes* scratch, const HitTextures& t) {
  MicrofacetLightOf<ByHit> light;
  Assign(t.by_diffuse, light.diffuse);
  Assign(t.by_specular, light.specular);
  Assign(t.by_specular_f0, light.specular_f0);
  Assign(t.by_specular_rise, light.specular_rise);
  Assign(t.by_diffuse_normal, light.diffuse_normal);
  Assign(t.by_diffuse_grazing, light.diffuse_grazing);
  Assign(t.by_turquin_f0, light.turquin_f0);
  Assign(t.by_turquin_rise, light.turquin_rise);
  Assign(t.by_multiple, light.multiple);
  MicrofacetUniformsOf<ByHit> uniforms{};
  uniforms.model = &model;
  uniforms.lights = &light;
  uniforms.alpha = t.alpha.data();
  uniforms.pi_over_alpha2 = t.pi_over_alpha2.data();
  uniforms.schlick_k = t.schlick_k.data();
  Assign(t.f0, uniforms.f0);
  Assign(t.dielectric_f0, uniforms.dielectric_f0);
  uniforms.dielectric_f90 = t.dielectric_f90.data();
  Assign(t.dielectric_f_multiple, uniforms.dielectric_f_multiple);
  uniforms.metallic = t.rounded_metallic.data();
  Assign(t.metal_f0, uniforms.metal_f0);
  Assign(t.f82_slope, uniforms.f82_slope);
  for (int c = 0; c < 3; ++c) {
    uniforms.eta[c] = static_cast<float>(model.eta[c]);
    uniforms.k[c] = static_cast<float>(model.k[c]);
  }
  uniforms.fit = own_fits ? t.fit.data() : nullptr;
  uniforms.fit_stride = HitTextures::kFitStride;
  if (AnyOf(t.double_alpha, range, [](double alpha) { return alpha >= 0; })) {
    NarrowGgxMaps(t.double_alpha.data(), range, scratch);
    uniforms.narrow = scratch->first.data();
  }
  if (model.base_form != DiffuseForm::kLambert) {
    SpreadBaseMaps(model.base_form, t.base_roughness.data(), range, &scratch->base);
    uniforms.spread = &scratch->base;
    Assign(t.base_ratio, uniforms.base_ratio);
  }
  ShadeByCurve(uniforms, range);
}

}  // namespace

bool HasMappedModel(const ShadingMaterial& material) {
  if (!material.mapped) return false;
  if (material.textured->vertex_colors == VertexColors::kBase) return true;
  for (const MapRole role : {MapRole::kDiffuse, MapRole::kSpecular, MapRole::kSpecularWeight,
                             MapRole::kWidth, MapRole::kMetallicRoughness}) {
    if (MapOf(*material.textured, role).valid()) return true;
  }
  return false;
}

bool HasOwnFits(const ShadingMaterial& material) {
  const bool by_roughness = std::holds_alternative<MicrofacetModel>(material.model) &&
                            MapOf(*material.textured, MapRole::kWidth).valid();
  return by_roughness || MapOf(*material.textured, MapRole::kMetallicRoughness).valid();
}

void ShadeMapped(const ShadingMaterial& material, const ShadeRange& range, NarrowLobes* scratch,
                 HitTextures* textures) {
  const bool own_fits = HasOwnFits(material);
  for (const LightOnBatch& light : range.lights) {
    MakeProducts({material, light.light->color, range.begin, range.end}, textures);
    ShadeRange one = range;
    one.lights = {&light, 1};
    if (&light != range.lights.data()) one.leaves = Leaves::kAddedParts;
    std::visit(
        Overloaded{[](std::monostate) {},
                   [&](const auto& model) { Shade(model, one, own_fits, scratch, *textures); }},
        material.model);
  }
}

}  // namespace nacre
