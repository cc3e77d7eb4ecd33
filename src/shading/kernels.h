// SPDX-License-Identifier: Apache-2.0
// shading/kernels.h: the SIMD kernels behind shade.h, and the uniforms that they take. Each
// reflection model has a file, and microfacet models have one per Fresnel curve: Schlick's and F82,
// of all models, are in metallic_roughness_kernel.cc.
#pragma once

#include "shading/layer.h"
#include "shading/light.h"
#include "shading/models.h"
#include "shading/surface.h"

namespace nacre {

struct HitParameters;

// MatteUniforms, PhongUniforms and MicrofacetUniforms are the input of a kernel besides the hits.
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
  const SharpLobeTerms* sharp;  // null if no lobe of the range is sharp
};

template <class Number>
struct MicrofacetUniforms : MicrofacetConstants<Number> {
  const MicrofacetModel* model;
  MicrofacetLight<Number> light;
  float eta[3] = {}, k[3] = {};
  // SharpLobeTerms::distribution, or null if no lobe of the range is sharp.
  const float* sharp_distribution = nullptr;
  // HitParameters::fit if hits have a roughness each: entry k of hit i is at [k * fit_stride + i].
  // Null if all hits have the model's fit.
  const float* fit = nullptr;
  size_t fit_stride = 0;
  // The factors of a rough base, or null if the base is Lambertian.
  const BaseSpread* spread = nullptr;
};

// Hits [begin, end) of a batch, the light on them, and where to store the radiance. `on_hits` is
// the light evaluated at the hits, or null (see LitHits).
struct ShadeRange {
  const HitBatch& hits;
  const Surface& surface;
  const ShadingLight& light;
  const LightBatch* on_hits;
  size_t begin, end;
  ReflectedRadiance* radiance;
  bool components;
};

// PrepareRun for microfacet materials (prepare_kernel.cc). `fit` and `fit_stride` are as in
// MicrofacetUniforms.
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

// Computes SharpLobeTerms of the hits of a range (sharp_lobe_kernel.cc).
void FormSharpGgx(double alpha, const ShadeRange& range, SharpLobeTerms* terms);
void FormSharpPhong(PhongModel model, const ShadeRange& range, SharpLobeTerms* terms);
// These overloads are for hits with an alpha or exponent each. The lobe of hit i is wide if
// alphas[i] < 0, or if the exponent is not above kDoubleTermsShininess.
void FormSharpGgx(const double* alphas, const ShadeRange& range, SharpLobeTerms* terms);
void FormSharpPhong(PhongModel model, const double* exponents, const ShadeRange& range,
                    SharpLobeTerms* terms);

// Computes the factors of a rough base under the light of a range, at every hit. All hits share one
// roughness, or each has its own.
void SpreadBase(DiffuseForm form, float roughness, const ShadeRange& range, BaseSpread* to);
void SpreadBase(DiffuseForm form, const float* roughness, const ShadeRange& range, BaseSpread* to);

// Adds a layer over the model and the layers below it: range.radiance holds what those reflect, and
// becomes what all reflect (cover_kernel.cc). `textures` is null unless hits have parameters of
// their own.
void CoverByLayer(const LayerModel& layer, const HitParameters* textures, const ShadeRange& range);

// Each kernel has an overload for constants that all hits share, and one for constants of each hit.
void ShadeMatte(const MatteUniforms<float>& uniforms, const ShadeRange& range);
void ShadeMatte(const MatteUniforms<float*>& uniforms, const ShadeRange& range);
void ShadePhong(const PhongUniforms<float>& uniforms, const ShadeRange& range);
void ShadePhong(const PhongUniforms<float*>& uniforms, const ShadeRange& range);
// Microfacet kernels, by the model's Fresnel curve.
void ShadeSchlick(const MicrofacetUniforms<float>& uniforms, const ShadeRange& range);
void ShadeSchlick(const MicrofacetUniforms<float*>& uniforms, const ShadeRange& range);
void ShadeF82(const MicrofacetUniforms<float>& uniforms, const ShadeRange& range);
void ShadeF82(const MicrofacetUniforms<float*>& uniforms, const ShadeRange& range);
void ShadeDielectric(const MicrofacetUniforms<float>& uniforms, const ShadeRange& range);
void ShadeDielectric(const MicrofacetUniforms<float*>& uniforms, const ShadeRange& range);
void ShadeConductor(const MicrofacetUniforms<float>& uniforms, const ShadeRange& range);
void ShadeConductor(const MicrofacetUniforms<float*>& uniforms, const ShadeRange& range);

}  // namespace nacre
