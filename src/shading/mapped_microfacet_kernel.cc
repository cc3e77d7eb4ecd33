// SPDX-License-Identifier: Apache-2.0
// shading/mapped_microfacet_kernel.cc: what maps make of a lobe and its base at each hit. As
// mapped_kernel.cc, the arithmetic of material.cc in plain loops.
#include <cmath>

#include "brdf/albedo_table.h"
#include "brdf/fresnel.h"
#include "brdf/fresnel_average.h"
#include "brdf/multi_scatter.h"
#include "shading/mapped.h"
#include "shading/texture_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/mapped_microfacet_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "shading/mapped-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {

// A hit's fit; that of MakeAlbedoFit, to the bit. The coefficients of both curves are one array.
struct HitFit {
  static constexpr size_t kCoefficients = 2 * kAlbedoTerms;
  AlbedoShape shape;
  float coefficients[kCoefficients] = {};
  double e_average = 1, schlick_average = 0;
  double average = 0;  // kDielectric
};

// Adds `weight` times the curve to `coefficients`.
void AddCurve(float weight, const float* curve, float* coefficients) {
  for (size_t k = 0; k < kAlbedoTerms; ++k) coefficients[k] += weight * curve[k];
}

// The second curve is Schlick's, or that of a dielectric's index.
void MakeFit(const MicrofacetModel& model, double roughness, HitFit* fit) {
  if (model.compensation == Compensation::kKullaConty) {
    const AlbedoFit whole = MakeAlbedoFit(model.shadowing, roughness);
    fit->e_average = whole.e_average;
    fit->schlick_average = whole.schlick_average;
  }
  const DielectricCurves* const curves = model.curves.get();
  fit->shape = MakeAlbedoShape(model.shadowing, roughness);
  fit->average = curves != nullptr ? 0 : model.albedo.average;
  const AlbedoWeights at = FindAlbedoWeights(roughness);
  float* const first = fit->coefficients;
  float* const second = first + kAlbedoTerms;
  std::fill(first, first + HitFit::kCoefficients, 0.0f);
  for (int i = 0; i < 4; ++i) {
    const auto node = static_cast<size_t>(at.first + i);
    const AlbedoEntry& entry = kAlbedoTable[static_cast<int>(model.shadowing)][node];
    const auto weight = static_cast<float>(at.weights[i]);
    AddCurve(weight, entry.one, first);
    AddCurve(weight, curves != nullptr ? curves->fresnel[node].data() : entry.schlick, second);
    if (curves != nullptr) fit->average += at.weights[i] * curves->average[node];
  }
  if (!(fit->shape.offset > 0)) std::fill(second, second + kAlbedoTerms, 0.0f);
}

void PutFit(const HitFit& fit, size_t i, HitTextures* t) {
  float* to = t->fit.data() + i;
  const auto put = [&](float value) {
    *to = value;
    to += HitTextures::kFitStride;
  };
  put(fit.shape.offset);
  put(fit.shape.scale);
  put(fit.shape.k);
  put(fit.shape.softening);
  for (const float coefficient : fit.coefficients) put(coefficient);
}

// Kulla and Conty's lobe of a hit: what PrepareKullaConty of material.cc does.
// `by_hit`: the means of the Fresnel curves are each hit's own, not the model's.
void FinishKullaConty(const MicrofacetModel& model, const HitFit& fit, bool by_hit, size_t i,
                      HitTextures* t) {
  t->multiple_scale[i] = static_cast<float>(KullaContyScale(fit.e_average));
  for (int c = 0; c < 3; ++c) {
    const double f0 = Channel(t->exact_dielectric_f0, c)[i];
    const double f90 = t->exact_dielectric_f90[i];
    const double metal_f0 = Channel(t->exact_metal_f0, c)[i];
    const double metallic = t->metallic[i];
    const double dielectric_f_average =
        by_hit ? AverageSchlick(f0, f90) : model.dielectric_f_average[c];
    const double metal_f_average =
        by_hit ? AverageF82(metal_f0, Channel(t->exact_slope, c)[i]) : model.metal_f_average[c];
    const double f_multiple = KullaContyFresnel(dielectric_f_average, fit.e_average);
    const double mixed =
        (1 - metallic) * f_multiple + metallic * KullaContyFresnel(metal_f_average, fit.e_average);
    Channel(t->exact_f_multiple, c)[i] = mixed;
    Channel(t->f_multiple, c)[i] = static_cast<float>(mixed);
    Channel(t->dielectric_f_multiple, c)[i] = static_cast<float>(f_multiple);
    if (model.coupling != DiffuseCoupling::kAlbedoScaled) continue;
    const double single =
        model.fresnel == FresnelForm::kDielectric
            ? fit.average
            : f0 * (fit.e_average - fit.schlick_average) + f90 * fit.schlick_average;
    const double left = 1 - single - f_multiple * (1 - fit.e_average);
    double& diffuse = Channel(t->diffuse, c)[i];
    diffuse = left > 0 ? diffuse / left : 0;
  }
}

// Albedo fits, but for hits of the same roughness as the one before.
void FinishAlbedo(const TexturedRun& run, const MicrofacetModel& model, HitTextures* t) {
  const bool kulla_conty = model.compensation == Compensation::kKullaConty;
  const bool own_fits = HasOwnFits(run.material);
  const bool own_colors =
      std::holds_alternative<MetallicRoughnessMaterial>(run.material.textured->model);
  if (!own_fits && !kulla_conty) return;
  HitFit fit;
  double last = -1;
  for (size_t i = run.begin; i < run.end; ++i) {
    if (t->width[i] != last) {
      last = t->width[i];
      MakeFit(model, last, &fit);
    }
    if (own_fits) PutFit(fit, i, t);
    if (kulla_conty) FinishKullaConty(model, fit, own_colors, i, t);
  }
}

// Bases that are not Lambert's.
void FinishBase(const TexturedRun& run, const MicrofacetModel& model,
                const std::optional<double>& roughness, HitTextures* t) {
  if (model.base_form == DiffuseForm::kLambert) return;
  const auto at = [&](size_t i) { return roughness.value_or(t->width[i]); };
  Hits{run.begin, run.end}.Fill(t->base_roughness.data(), at);
  FinishRatio(run, at, t);
}

// Both Fresnel curves and their mix, and what is left for the base, from colour and metallic of
// each hit.
void FinishMetallicRoughness(const TexturedRun& run, const MetallicRoughnessMaterial& material,
                             HitTextures* t) {
  FinishLayers(run, Rgb(1), Rgb(1), t);
  const auto& model = std::get<MicrofacetModel>(run.material.model);
  const Hits hits{run.begin, run.end};
  const double* const metallic = t->metallic.data();
  const double* const specular = t->exact_dielectric_f90.data();
  FinishBase(run, model, material.diffuse_roughness, t);
  for (int c = 0; c < 3; ++c) {
    double* const diffuse = Channel(t->diffuse, c);
    double* const f0 = Channel(t->specular, c);
    double* const dielectric_f0 = Channel(t->exact_dielectric_f0, c);
    double* const metal_f0 = Channel(t->exact_metal_f0, c);
    double* const slope = Channel(t->exact_slope, c);
    hits.Fill(dielectric_f0, [&](size_t i) { return f0[i] * specular[i]; });
    hits.Fill(metal_f0, [&](size_t i) { return diffuse[i]; });
    hits.Fill(f0, [&](size_t i) {
      return (1 - metallic[i]) * dielectric_f0[i] + metallic[i] * metal_f0[i];
    });
    hits.Fill(diffuse, [&](size_t i) { return diffuse[i] * ((1 - metallic[i]) * M_1_PI); });
    if (model.fresnel == FresnelForm::kSchlick) {
      hits.Fill(slope, [](size_t) { return 0.0; });
      continue;
    }
    const double tint = material.f82_tint[c];
    hits.Fill(slope, [&](size_t i) { return F82SlopeFromTint(metal_f0[i], tint); });
  }
  hits.Fill(t->exact_f90.data(),
            [&](size_t i) { return 1 - (1 - specular[i]) * (1 - metallic[i]); });
}

// Those of a conductor and a dielectric are the model's.
void FillFresnel(const TexturedRun& run, HitTextures* t) {
  const auto& model = std::get<MicrofacetModel>(run.material.model);
  const Hits hits{run.begin, run.end};
  FillRgb(hits, model.f0, &t->specular);
  FillRgb(hits, model.dielectric_f0, &t->exact_dielectric_f0);
  FillRgb(hits, model.metal_f0, &t->exact_metal_f0);
  FillRgb(hits, model.f82_slope, &t->exact_slope);
  FillNumber(hits, model.f90, &t->exact_f90);
  FillNumber(hits, model.dielectric_f90, &t->exact_dielectric_f90);
  FillNumber(hits, model.metallic, &t->metallic);
}

void FinishConductor(const TexturedRun& run, HitTextures* t) {
  FillFresnel(run, t);
  FillRgb({run.begin, run.end}, Rgb(0, 0, 0), &t->diffuse);
}

void FinishDielectric(const TexturedRun& run, const DielectricMaterial& material, HitTextures* t) {
  const Hits hits{run.begin, run.end};
  const double gloss = AverageDielectric(material.ior);
  FinishLayers(run, Rgb(1), Rgb(1), t);
  FinishBase(run, std::get<MicrofacetModel>(run.material.model), material.diffuse_roughness, t);
  FillFresnel(run, t);
  for (int c = 0; c < 3; ++c) {
    double* const diffuse = Channel(t->diffuse, c);
    const double radiance = run.material.ambient_radiance[c];
    hits.Fill(Channel(t->ambient, c),
              [&](size_t i) { return (gloss + diffuse[i] * (1 - gloss)) * radiance; });
    hits.Fill(diffuse, [&](size_t i) { return diffuse[i] * M_1_PI; });
  }
}

// The constants of the lobe, from each hit's roughness.
void FinishLobe(const TexturedRun& run, Shadowing shadowing, HitTextures* t) {
  for (size_t i = run.begin; i < run.end; ++i) {
    const double r = t->width[i], alpha = AlphaFromRoughness(r);
    const bool delta = IsDeltaLobe(alpha);
    const double shown = delta ? 1 : alpha;
    t->alpha[i] = static_cast<float>(shown);
    t->pi_over_alpha2[i] = static_cast<float>(M_PI / (shown * shown));
    t->schlick_k[i] = static_cast<float>(SchlickK(shadowing, r));
    t->not_delta[i] = delta ? 0.0f : 1.0f;
    t->double_alpha[i] = IsNarrow(r, alpha) ? alpha : -1;
  }
}

void Round(const Hits& hits, const double* from, float* to) {
  hits.Fill(to, [&](size_t i) { return from[i]; });
}

void FinishMicrofacetT(const TexturedRun& run, HitTextures* t) {
  const Material& material = *run.material.textured;
  if (const auto* metallic = std::get_if<MetallicRoughnessMaterial>(&material.model)) {
    FinishMetallicRoughness(run, *metallic, t);
  } else if (const auto* dielectric = std::get_if<DielectricMaterial>(&material.model)) {
    FinishDielectric(run, *dielectric, t);
  } else {
    FinishConductor(run, t);
  }
  const Hits hits{run.begin, run.end};
  const auto& model = std::get<MicrofacetModel>(run.material.model);
  for (int c = 0; c < 3; ++c) {
    Round(hits, Channel(t->specular, c), Channel(t->f0, c));
    Round(hits, Channel(t->exact_dielectric_f0, c), Channel(t->dielectric_f0, c));
    if (model.fresnel != FresnelForm::kF82) continue;
    Round(hits, Channel(t->exact_metal_f0, c), Channel(t->metal_f0, c));
    Round(hits, Channel(t->exact_slope, c), Channel(t->f82_slope, c));
  }
  Round(hits, t->exact_f90.data(), t->f90.data());
  Round(hits, t->exact_dielectric_f90.data(), t->dielectric_f90.data());
  if (model.fresnel == FresnelForm::kF82) {
    Round(hits, t->metallic.data(), t->rounded_metallic.data());
  }
  FinishLobe(run, model.shadowing, t);
  if (model.prepared) FinishAlbedo(run, model, t);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(FinishMicrofacetT);

void FinishMicrofacet(const TexturedRun& run, HitTextures* textures) {
  HWY_DYNAMIC_DISPATCH(FinishMicrofacetT)(run, textures);
}
}  // namespace nacre
#endif
