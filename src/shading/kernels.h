// SPDX-License-Identifier: Apache-2.0
// shading/kernels.h: the SIMD kernels behind shade.h, one file per reflection model, and the
// uniforms that they take.
#pragma once

#include <span>

#include "shading/shade.h"

namespace nacre {

// What kernels read beside the constants of constants.h.
template <class Number>
struct MatteUniforms {
  DiffuseForm form;
  MatteConstants<Number> constants;
  const MatteLight<Number>* lights;
};

template <class Number>
struct PhongUniforms {
  PhongModel model;
  PhongConstants<Number> constants;
  const PhongLight<Number>* lights;
  const SharpLobeTerms* sharp;  // for a range under one light; or null
};

// Where a channel reflects as little at normal incidence, Schlick's weight needs 1 - v.h to its
// last digit. Else it may be off by 2e-7: (1 - v.h)^5 is off by 5 (1 - v.h)^4 times that, Schlick's
// curve by 1.4e-6 of itself at most.
inline constexpr float kBrightF0 = 0.02f;

template <class Number>
struct MicrofacetUniforms : MicrofacetConstants<Number> {
  const MicrofacetModel* model;
  const MicrofacetLight<Number>* lights;
  bool is_bright = false;  // no channel of f0 is below kBrightF0; not of hits with their own
  float eta[3] = {}, k[3] = {};
  const float* sharp_distribution = nullptr;  // of SharpLobeTerms, under one light; or null
  // Of hits with a roughness each: HitTextures::fit, of which it is entry k of hit i at
  // [k * stride + i]. Null: all have the model's.
  const float* fit = nullptr;
  size_t fit_stride = 0;
  // How a rough base spreads the light, under one light; or null: as Lambert's.
  const BaseSpread* spread = nullptr;
};

// Hits [begin, end) of a batch, the lights on them and where their radiance goes.
struct ShadeRange {
  const HitBatch& hits;
  const Surface& surface;
  std::span<const LightOnBatch> lights;
  size_t begin, end;
  ReflectedRadiance* radiance;
  OutputMode output = OutputMode::kAccumulate;
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

// SharpLobeTerms of hits under the first light of a range (sharp_lobe_kernel.cc).
void FormSharpGgx(double alpha, const ShadeRange& range, SharpLobeTerms* terms);
void FormSharpPhong(PhongModel model, const ShadeRange& range, SharpLobeTerms* terms);
// Of hits with an alpha or exponent each; lobes are wide where alphas[i] is below 0, or the
// exponent not above kDoubleTermsShininess.
void FormSharpGgx(const double* alphas, const ShadeRange& range, SharpLobeTerms* terms);
void FormSharpPhong(PhongModel model, const double* exponents, const ShadeRange& range,
                    SharpLobeTerms* terms);

// How a rough base spreads the first light of a range, at every hit; roughness: one of all, or of
// each hit.
void SpreadBase(DiffuseForm form, float roughness, const ShadeRange& range, BaseSpread* to);
void SpreadBase(DiffuseForm form, const float* roughness, const ShadeRange& range, BaseSpread* to);

// A layer over what hits reflect of a range's one light, which has been evaluated: `below` is what
// the model and the layers below reflect, and range.radiance, which may be the same, what all do
// (layer_kernel.cc). `textures`: of hits with numbers of their own; else null.
void CoverByLayer(const LayerModel& layer, const HitTextures* textures, const ShadeRange& range,
                  const ReflectedRadiance& below);

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
