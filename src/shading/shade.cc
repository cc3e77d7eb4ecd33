// SPDX-License-Identifier: Apache-2.0
#include "shading/shade.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "base/overloaded.h"
#include "shading/kernels.h"
#include "shading/mapped.h"

namespace nacre {
namespace {

// Lights that one call of a kernel shades by. More make several calls, with the same bits: sums
// between calls are kept in the floats that they are formed in.
constexpr size_t kLightsAtOnce = 16;

void Assign(const Rgb& from, float (&to)[3]) {
  for (int c = 0; c < 3; ++c) to[c] = static_cast<float>(from[c]);
}

LambertLight MakeLight(const LambertModel& model, const Rgb& color) {
  LambertLight light;
  Assign(model.diffuse * color, light.diffuse);
  return light;
}

LambertLight MakeLight(const RoughMatteModel& model, const Rgb& color) {
  return MakeLight(LambertModel{model.diffuse}, color);
}

PhongLight MakeLight(const PhongFamilyModel& model, const Rgb& color) {
  PhongLight light;
  Assign(model.diffuse * color, light.diffuse);
  Assign(model.specular * color, light.specular);
  return light;
}

// What the model's curve and compensation ask for alone: a batch has few hits of each material.
MicrofacetLight MakeLight(const MicrofacetModel& model, const Rgb& color) {
  MicrofacetLight light;
  const Rgb specular = model.delta ? Rgb(0, 0, 0) : color;
  const Rgb diffuse = model.diffuse * color;
  if (model.fresnel == FresnelForm::kSchlick) {
    const bool coupled = model.coupling == DiffuseCoupling::kOneMinusFresnel;
    Assign(model.f0 * specular, light.specular_f0);
    Assign((Rgb(model.f90) - model.f0) * specular, light.specular_rise);
    Assign(coupled ? (Rgb(1) - model.f0) * diffuse : diffuse, light.diffuse_normal);
    Assign(coupled ? (1 - model.f90) * diffuse : Rgb(0), light.diffuse_grazing);
    if (model.compensation == Compensation::kTurquin) {
      Assign(model.turquin_f0 * specular, light.turquin_f0);
      Assign((model.turquin_f90 - model.turquin_f0) * specular, light.turquin_rise);
    }
  } else {
    Assign(diffuse, light.diffuse);
    Assign(specular, light.specular);
  }
  if (model.compensation == Compensation::kKullaConty) {
    Assign(model.f_multiple * color, light.multiple);
  }
  return light;
}

MicrofacetUniforms MakeUniforms(const MicrofacetModel& model, const MicrofacetLight* lights) {
  const double alpha = model.delta ? 1 : model.alpha;
  MicrofacetUniforms uniforms{};
  uniforms.model = &model;
  uniforms.lights = lights;
  uniforms.alpha = static_cast<float>(alpha);
  uniforms.pi_over_alpha2 = static_cast<float>(M_PI / (alpha * alpha));
  uniforms.schlick_k = static_cast<float>(model.schlick_k);
  Assign(model.f0, uniforms.f0);
  uniforms.is_bright = std::min({uniforms.f0[0], uniforms.f0[1], uniforms.f0[2]}) >= kBrightF0;
  Assign(model.dielectric_f0, uniforms.dielectric_f0);
  uniforms.dielectric_f90 = static_cast<float>(model.dielectric_f90);
  if (model.fresnel == FresnelForm::kF82) {
    uniforms.metallic = static_cast<float>(model.metallic);
    Assign(model.metal_f0, uniforms.metal_f0);
    Assign(model.f82_slope, uniforms.f82_slope);
  }
  if (model.fresnel == FresnelForm::kDielectric || model.fresnel == FresnelForm::kConductor) {
    Assign(model.eta, uniforms.eta);
    Assign(model.k, uniforms.k);
  }
  if (model.compensation == Compensation::kKullaConty) {
    Assign(model.dielectric_f_multiple, uniforms.dielectric_f_multiple);
  }
  if (model.base_form != DiffuseForm::kLambert) Assign(model.base_ratio, uniforms.base_ratio);
  return uniforms;
}

void ShadeByCurve(const MicrofacetUniforms& uniforms, const ShadeRange& range) {
  switch (uniforms.model->fresnel) {
    case FresnelForm::kSchlick:
      return ShadeSchlick(uniforms, range);
    case FresnelForm::kF82:
      return ShadeF82(uniforms, range);
    case FresnelForm::kDielectric:
      return ShadeDielectric(uniforms, range);
    case FresnelForm::kConductor:
      return ShadeConductor(uniforms, range);
  }
}

// Calls shade(lights, range) for groups of at most `at_once` lights of the range, with the
// constants of model and light.
template <class Model, class Shade>
void ForEachGroup(const Model& model, const ShadeRange& range, size_t at_once, const Shade& shade) {
  std::array<decltype(MakeLight(model, Rgb())), kLightsAtOnce> lights;
  for (size_t first = 0; first < range.lights.size(); first += at_once) {
    const size_t count = std::min(at_once, range.lights.size() - first);
    for (size_t k = 0; k < count; ++k) {
      lights[k] = MakeLight(model, range.lights[first + k].light->color);
    }
    ShadeRange group = range;
    group.lights = range.lights.subspan(first, count);
    if (first > 0) group.leaves = Leaves::kAddedParts;
    shade(lights.data(), group);
  }
}

void Shade(const LambertModel& lambert, const ShadeRange& range) {
  ForEachGroup(lambert, range, kLightsAtOnce, ShadeLambert);
}

void Shade(const RoughMatteModel& model, const ShadeRange& range) {
  ForEachGroup(
      model, range, kLightsAtOnce, [&](const LambertLight* lights, const ShadeRange& group) {
        RoughMatteUniforms uniforms{model.form, static_cast<float>(model.roughness), lights, {}};
        Assign(model.ratio, uniforms.ratio);
        ShadeRoughMatte(uniforms, group);
      });
}

void Shade(const PhongFamilyModel& phong, const ShadeRange& range, NarrowLobes* scratch) {
  const size_t at_once = phong.double_terms ? 1 : kLightsAtOnce;
  ForEachGroup(phong, range, at_once, [&](const PhongLight* lights, const ShadeRange& group) {
    PhongUniforms uniforms{phong.model, static_cast<float>(phong.shininess), lights, nullptr};
    if (phong.double_terms) {
      NarrowPhong(phong.model, group, scratch);
      uniforms.narrow = scratch;
    }
    ShadePhong(uniforms, group);
  });
}

void Shade(const MicrofacetModel& model, const ShadeRange& range, NarrowLobes* scratch) {
  const bool rough_base = model.base_form != DiffuseForm::kLambert;
  const size_t at_once = model.double_terms || rough_base ? 1 : kLightsAtOnce;
  ForEachGroup(model, range, at_once, [&](const MicrofacetLight* lights, const ShadeRange& group) {
    MicrofacetUniforms uniforms = MakeUniforms(model, lights);
    if (model.double_terms) {
      NarrowGgx(model.alpha, group, scratch);
      uniforms.narrow = scratch->first.data();
    }
    if (rough_base) {
      SpreadBase(model.base_form, static_cast<float>(model.base_roughness), group, &scratch->base);
      uniforms.spread = &scratch->base;
    }
    ShadeByCurve(uniforms, group);
  });
}

}  // namespace

bool EvaluatedInPlace(const ShadingLight& light) {
  return light.form == LightForm::kDirectional || light.form == LightForm::kInverseSquare;
}

void PrepareRun(const ShadingMaterial& material, size_t begin, size_t end, Surface* surface,
                const HitTextures* textures) {
  const auto* microfacet = std::get_if<MicrofacetModel>(&material.model);
  if (microfacet == nullptr || !microfacet->prepared) return;
  if (HasMappedModel(material)) {
    PrepareMicrofacetMaps(*microfacet, *textures, HasOwnFits(material), begin, end, surface);
  } else {
    PrepareMicrofacet(*microfacet, begin, end, surface);
  }
}

void ShadeRun(const ShadingMaterial& material, const LitHits& lit, size_t begin, size_t end,
              NarrowLobes* scratch, ReflectedRadiance* radiance) {
  const ShadeRange range{lit.hits, lit.surface, lit.lights, begin, end, radiance, lit.leaves};
  if (HasMappedModel(material)) return ShadeMapped(material, range, scratch, lit.textures);
  std::visit(
      Overloaded{[](std::monostate) {}, [&](const LambertModel& lambert) { Shade(lambert, range); },
                 [&](const RoughMatteModel& matte) { Shade(matte, range); },
                 [&](const auto& model) { Shade(model, range, scratch); }},
      material.model);
}

void ClearSoa(size_t count, Soa3<float>* soa) {
  std::fill_n(soa->x.data(), count, 0.0f);
  std::fill_n(soa->y.data(), count, 0.0f);
  std::fill_n(soa->z.data(), count, 0.0f);
}

void ClearRadiance(size_t count, ReflectedRadiance* radiance) {
  ClearSoa(count, &radiance->diffuse);
  ClearSoa(count, &radiance->specular);
  ClearSoa(count, &radiance->sum);
}

}  // namespace nacre
