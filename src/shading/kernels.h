// SPDX-License-Identifier: Apache-2.0
// shading/kernels.h: the SIMD kernels behind shade.h, and the uniforms that they take. One file
// per reflection model, and of microfacet models one per Fresnel curve: those by Schlick and F82 of
// all models are in metallic_roughness_kernel.cc.
#pragma once

#include "shading/shade.h"

namespace nacre {

// What kernels read beside the constants of constants.h.
template <class Number>
struct MatteUniforms {
  DiffuseForm form;
  MatteConstants<Number> constants;
  MatteLight<Number> light;
};

template <class Number>
struct PhongUniforms {
  PhongModel model;
  PhongConstants<Number> constants;
  PhongLight<Number> light;
  const SharpLobeTerms* sharp;  // or null
};

template <class Number>
struct MicrofacetUniforms : MicrofacetConstants<Number> {
  const MicrofacetModel* model;
  MicrofacetLight<Number> light;
  float eta[3] = {}, k[3] = {};
  const float* sharp_distribution = nullptr;  // of SharpLobeTerms; or null
  // Of hits with a roughness each: HitTextures::fit, of which it is entry k of hit i at
  // [k * stride + i]. Null: all have the model's.
  const float* fit = nullptr;
  size_t fit_stride = 0;
  // How a rough base spreads the light; or null: as Lambert's.
  const BaseSpread* spread = nullptr;
};

// Hits [begin, end) of a batch, the light on them and where their radiance goes.
struct ShadeRange {
  const HitBatch& hits;
  const Surface& surface;
  const ShadingLight& light;
  const LightBatch* on_hits;
  size_t begin, end;
  ReflectedRadiance* radiance;
  bool components;
};

// PrepareRun of microfacet materials (prepare_kernel.cc). `fit`, `fit_stride`: MicrofacetUniforms'.
template <class Number>
struct PrepareUniforms : MicrofacetConstants<Number> {
  const MicrofacetModel& model;
  const float* fit;
  size_t fit_stride;
};
void PrepareMicrofacet(const PrepareUniforms<float>& uniforms, size_t begin, size_t end,
                       Surface* surface);
void PrepareMicrofacet(const PrepareUniforms<float*>& uniforms, size_t begin, size_t end,
                       Surface* surface);

// SharpLobeTerms of the hits of a range (sharp_lobe_kernel.cc).
void FormSharpGgx(double alpha, const ShadeRange& range, SharpLobeTerms* terms);
void FormSharpPhong(PhongModel model, const ShadeRange& range, SharpLobeTerms* terms);
// Of hits with an alpha or exponent each; lobes are wide where alphas[i] is below 0, or the
// exponent not above kDoubleTermsShininess.
void FormSharpGgx(const double* alphas, const ShadeRange& range, SharpLobeTerms* terms);
void FormSharpPhong(PhongModel model, const double* exponents, const ShadeRange& range,
                    SharpLobeTerms* terms);

// How a rough base spreads the light of a range, at every hit; roughness: one of all, or of each
// hit.
void SpreadBase(DiffuseForm form, float roughness, const ShadeRange& range, BaseSpread* to);
void SpreadBase(DiffuseForm form, const float* roughness, const ShadeRange& range, BaseSpread* to);

// Puts a layer over the model and the layers below it: range.radiance is what those reflect, and
// becomes what all reflect (layer_kernel.cc). `textures`: of hits with numbers of their own; else
// null.
void CoverByLayer(const LayerModel& layer, const HitTextures* textures, const ShadeRange& range);

// Each of one material's constants, and of each hit's.
void ShadeMatte(const MatteUniforms<float>& uniforms, const ShadeRange& range);
void ShadeMatte(const MatteUniforms<float*>& uniforms, const ShadeRange& range);
void ShadePhong(const PhongUniforms<float>& uniforms, const ShadeRange& range);
void ShadePhong(const PhongUniforms<float*>& uniforms, const ShadeRange& range);
// By the curve of the model's Fresnel term.
void ShadeSchlick(const MicrofacetUniforms<float>& uniforms, const ShadeRange& range);
void ShadeSchlick(const MicrofacetUniforms<float*>& uniforms, const ShadeRange& range);
void ShadeF82(const MicrofacetUniforms<float>& uniforms, const ShadeRange& range);
void ShadeF82(const MicrofacetUniforms<float*>& uniforms, const ShadeRange& range);
void ShadeDielectric(const MicrofacetUniforms<float>& uniforms, const ShadeRange& range);
void ShadeDielectric(const MicrofacetUniforms<float*>& uniforms, const ShadeRange& range);
void ShadeConductor(const MicrofacetUniforms<float>& uniforms, const ShadeRange& range);
void ShadeConductor(const MicrofacetUniforms<float*>& uniforms, const ShadeRange& range);

}  // namespace nacre
