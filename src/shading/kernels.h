// SPDX-License-Identifier: Apache-2.0
// shading/kernels.h: the SIMD kernels behind shade.h, one file per reflection model, and the
// uniforms that they take: products of material and light, computed in double, rounded once.
#pragma once

#include <span>

#include "shading/shade.h"

namespace nacre {

// What follows comes in two forms. Number is float: the same for all hits. Or it is const float*:
// one for each hit of the batch, of materials with maps, shaded under one light at a time.

// Products of one light and the material's constants, for each light of a range.
template <class Number>
struct LambertLightOf {
  Number diffuse[3];  // albedo / pi * light
};
using LambertLight = LambertLightOf<float>;

template <class Number>
struct RoughMatteUniformsOf {
  DiffuseForm form;  // not Lambert's
  float roughness;
  const LambertLightOf<Number>* lights;
  Number ratio[3];  // kOrenNayar: EonMultipleRatio of the albedo
};
using RoughMatteUniforms = RoughMatteUniformsOf<float>;

template <class Number>
struct PhongLightOf {
  Number diffuse[3], specular[3];  // PhongFamilyModel's constants times light
};
using PhongLight = PhongLightOf<float>;

template <class Number>
struct PhongUniformsOf {
  PhongModel model;
  Number shininess;
  const PhongLightOf<Number>* lights;
  // Terms formed in double, for a range under one light; or null. Where each hit has its exponent,
  // `first` is below 0 at those whose lobe is wide.
  const NarrowLobes* narrow;
};
using PhongUniforms = PhongUniformsOf<float>;

template <class Number>
struct MicrofacetLightOf {
  Number diffuse[3];   // MicrofacetModel::diffuse * light
  Number specular[3];  // light; 0 for a delta lobe, which these lights cannot show
  // kSchlick, with its curve multiplied in: `specular` times F0 and F90 - F0, what it starts from
  // and what it rises by; `diffuse` times 1 - F0 and 1 - F90, what is left at normal incidence and
  // at grazing angles, or times 1 and 0 where the base is not coupled to the lobe.
  Number specular_f0[3], specular_rise[3], diffuse_normal[3], diffuse_grazing[3];
  // kSchlick and kTurquin: `specular` times turquin_f0 and turquin_f90 - turquin_f0.
  Number turquin_f0[3], turquin_rise[3];
  Number multiple[3];  // kKullaConty: F_ms * light
};
using MicrofacetLight = MicrofacetLightOf<float>;

// Where a channel reflects as little at normal incidence, Schlick's weight needs 1 - v.h to its
// last digit. Else it may be off by 2e-7: (1 - v.h)^5 is off by 5 (1 - v.h)^4 times that, Schlick's
// curve by 1.4e-6 of itself at most.
inline constexpr float kBrightF0 = 0.02f;

template <class Number>
struct MicrofacetUniformsOf {
  const MicrofacetModel* model;
  const MicrofacetLightOf<Number>* lights;
  // The model's, rounded.
  Number alpha, pi_over_alpha2, schlick_k;
  Number f0[3];
  bool is_bright;  // no channel of f0 is below kBrightF0; not of hits with their own
  // What covers the base; kKullaConty: with dielectric_f_multiple.
  Number dielectric_f0[3], dielectric_f90, dielectric_f_multiple[3];
  Number metallic, metal_f0[3], f82_slope[3];  // kF82, with what is above
  float eta[3], k[3];
  // The distribution at each hit, formed in double, under one light; or null. Where each hit has
  // its alpha, below 0 at those whose lobe is wide.
  const float* narrow;
  // Of hits with a roughness each: their albedo fits, entry k of hit i at [k * stride + i]. Null:
  // all have the model's.
  const float* fit = nullptr;
  size_t fit_stride = 0;
  // How a rough base spreads the light, under one light; or null: as Lambert's.
  const BaseSpread* spread = nullptr;
  Number base_ratio[3] = {};  // with it: EonMultipleRatio of the base's colour
};
using MicrofacetUniforms = MicrofacetUniformsOf<float>;

// Hits [begin, end) of a batch, the lights on them and where their radiance goes.
struct ShadeRange {
  const HitBatch& hits;
  const Surface& surface;
  std::span<const LightOnBatch> lights;
  size_t begin, end;
  ReflectedRadiance* radiance;
  Leaves leaves = Leaves::kAddedParts;
};

void PrepareMicrofacet(const MicrofacetModel& model, size_t begin, size_t end, Surface* surface);

struct HitTextures;
// `own_fits`: hits have a roughness, and so an albedo fit, each; else all have the model's.
void PrepareMicrofacetMaps(const MicrofacetModel& model, const HitTextures& textures, bool own_fits,
                           size_t begin, size_t end, Surface* surface);

// The terms of narrow lobes under the first light of a range, formed in double and rounded to
// float. `first`: the GGX distribution.
void NarrowGgx(double alpha, const ShadeRange& range, NarrowLobes* lobes);
// `first`, `second`: 1 - c and c of the lobe's cosine c.
void NarrowPhong(PhongModel model, const ShadeRange& range, NarrowLobes* lobes);
// The same, of hits with an alpha or exponent each: `first` is -1 where alphas[i] is below 0, or
// the exponent not above kDoubleTermsShininess.
void NarrowGgxMaps(const double* alphas, const ShadeRange& range, NarrowLobes* lobes);
void NarrowPhongMaps(PhongModel model, const double* exponents, const ShadeRange& range,
                     NarrowLobes* lobes);

// How a rough base spreads the first light of a range, at every hit.
void SpreadBase(DiffuseForm form, float roughness, const ShadeRange& range, BaseSpread* to);
// The same, of hits with a roughness each.
void SpreadBaseMaps(DiffuseForm form, const float* roughness, const ShadeRange& range,
                    BaseSpread* to);

void ShadeLambert(const LambertLight* lights, const ShadeRange& range);
void ShadeRoughMatte(const RoughMatteUniforms& uniforms, const ShadeRange& range);
void ShadePhong(const PhongUniforms& uniforms, const ShadeRange& range);
// By the curve of the model's Fresnel term.
void ShadeSchlick(const MicrofacetUniforms& uniforms, const ShadeRange& range);
void ShadeF82(const MicrofacetUniforms& uniforms, const ShadeRange& range);
void ShadeDielectric(const MicrofacetUniforms& uniforms, const ShadeRange& range);
void ShadeConductor(const MicrofacetUniforms& uniforms, const ShadeRange& range);

// Of materials with maps.
void ShadeLambertMaps(const LambertLightOf<const float*>& light, const ShadeRange& range);
void ShadeRoughMatteMaps(const RoughMatteUniformsOf<const float*>& uniforms,
                         const ShadeRange& range);
void ShadePhongMaps(const PhongUniformsOf<const float*>& uniforms, const ShadeRange& range);
void ShadeSchlickMaps(const MicrofacetUniformsOf<const float*>& uniforms, const ShadeRange& range);
void ShadeF82Maps(const MicrofacetUniformsOf<const float*>& uniforms, const ShadeRange& range);
void ShadeDielectricMaps(const MicrofacetUniformsOf<const float*>& uniforms,
                         const ShadeRange& range);
void ShadeConductorMaps(const MicrofacetUniformsOf<const float*>& uniforms,
                        const ShadeRange& range);

}  // namespace nacre
