// SPDX-License-Identifier: Apache-2.0
// shading/kernels.h: the SIMD kernels behind shade.h, and the uniforms that they take. Each
// reflection model has a file.
#pragma once

#include <variant>

#include "shading/layer.h"
#include "shading/material_hits.h"
#include "shading/models.h"
#include "shading/surface.h"

namespace nacre {

// The exponent of a Phong lobe.
struct PhongExponent {
  float uniform;        // of all hits, if by_hit is null
  const float* by_hit;  // of each hit, or null
};

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

// The anisotropic lobes of a model, or of hits with parameters of their own.
inline AnisotropicLobes LobesOf(const MicrofacetModel& model) { return {model.anisotropic.get()}; }
inline AnisotropicLobes LobesOf(const ShadingMaterial& material, const MicrofacetModel& model,
                                const HitParameters* maps) {
  if (!model.anisotropic || maps == nullptr || !material.by_hit.width) return LobesOf(model);
  return {maps->lobes.data(), 1};
}

// The constants of a GGX lobe over a base, of the material or of each hit.
template <class Number>
struct MicrofacetNumbers : MicrofacetConstants<Number> {
  const MicrofacetModel& model;
  // HitParameters::fit if hits have a roughness each, or null if all have the model's fit.
  const float* fit = nullptr;
  AnisotropicLobes lobes;
};
inline MicrofacetNumbers<float> NumbersOfModel(const MicrofacetModel& model) {
  return {model.constants, model, nullptr, LobesOf(model)};
}
inline MicrofacetNumbers<float*> NumbersOfHits(const ShadingMaterial& material,
                                               const HitParameters& textures) {
  const auto& model = std::get<MicrofacetModel>(material.model);
  return {ColumnsIn<MicrofacetConstants<float*>>(textures.constants), model,
          material.by_hit.width ? textures.fit.data() : nullptr,
          LobesOf(material, model, &textures)};
}

template <class Number>
struct MicrofacetUniforms : MicrofacetNumbers<Number> {
  MicrofacetLight<Number> light;
  float eta[3] = {}, k[3] = {};
  // Arrays of SharpLobeTerms: the first is null if no lobe of the range is sharp, the others are if
  // the lobes are isotropic.
  const float* sharp_distribution = nullptr;
  const float *light_root = nullptr, *view_root = nullptr, *t_dot_l = nullptr, *b_dot_l = nullptr;
  // The factors of a rough base, or null if the base is Lambertian.
  const BaseSpread* spread = nullptr;
};

// PrepareRun for microfacet materials (prepare_kernel.cc).
void PrepareMicrofacet(const MicrofacetNumbers<float>& numbers, size_t begin, size_t end,
                       Surface* surface);
void PrepareMicrofacet(const MicrofacetNumbers<float*>& numbers, size_t begin, size_t end,
                       Surface* surface);

// Computes SharpLobeTerms of the hits of a range (sharp_lobe_kernel.cc).
// All hits share an alpha or exponent, or each has its own. A lobe is wide if its alpha is below 0,
// or if its exponent is not above kDoubleTermsShininess.
void FormSharpGgx(double alpha, const LitHits& lit, SharpLobeTerms* terms);
void FormSharpGgx(const double* alphas, const LitHits& lit, SharpLobeTerms* terms);
void FormAnisotropicGgx(const AnisotropicLobes& lobes, const LitHits& lit, SharpLobeTerms* terms);
void FormSharpPhong(PhongModel model, double exponent, const LitHits& lit, SharpLobeTerms* terms);
void FormSharpPhong(PhongModel model, const double* exponents, const LitHits& lit,
                    SharpLobeTerms* terms);

// Computes SharpLobeTerms of the hits under their light in `terms`, and returns it, or null if no
// hit has a sharp lobe (shade.cc).
const SharpLobeTerms* FormSharpTerms(const PhongFamilyModel& model, const LitHits& lit,
                                     SharpLobeTerms* terms);
const SharpLobeTerms* FormSharpTerms(const MicrofacetModel& model, const LitHits& lit,
                                     SharpLobeTerms* terms);

// Fills HitParameters::products with the MatteLight, PhongLight or MicrofacetLight of hits with
// maps, computed in double and rounded once, as for materials without maps (mapped_kernel.cc).
void MakeProducts(const LitHits& lit);

// Computes the factors of a rough base under the light of a range, at every hit. All hits share one
// roughness, or each has its own.
void SpreadBase(DiffuseForm form, float roughness, const LitHits& lit, BaseSpread* to);
void SpreadBase(DiffuseForm form, const float* roughness, const LitHits& lit, BaseSpread* to);

// Adds a layer over the model and the layers below it: lit.radiance holds what those reflect, and
// becomes what all reflect (cover_kernel.cc).
void CoverByLayer(const LayerModel& layer, const LitHits& lit);

// Adds a coat over what lies below it, which `radiance` holds: lit.radiance is what the coat's own
// lobe reflects (cover_kernel.cc).
void CoverByCoat(const LitHits& lit, const CoatHits& coat, ReflectedRadiance* radiance);

// Each kernel has an overload for constants that all hits share, and one for constants of each hit.
void ShadeMatte(const MatteUniforms<float>& uniforms, const LitHits& lit);
void ShadeMatte(const MatteUniforms<float*>& uniforms, const LitHits& lit);
void ShadePhong(const PhongUniforms<float>& uniforms, const LitHits& lit);
void ShadePhong(const PhongUniforms<float*>& uniforms, const LitHits& lit);
void ShadeMicrofacet(const MicrofacetUniforms<float>& uniforms, const LitHits& lit);
void ShadeMicrofacet(const MicrofacetUniforms<float*>& uniforms, const LitHits& lit);

}  // namespace nacre
