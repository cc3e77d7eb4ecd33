// SPDX-License-Identifier: Apache-2.0
// shading/microfacet_albedo-inl.h: the directional albedo of a microfacet lobe, and so the light
// that is left for the base under it and for multiple scattering. Scalar twin: CoverAlbedo
// (material.h).
#if defined(NACRE_SHADING_MICROFACET_ALBEDO_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_SHADING_MICROFACET_ALBEDO_INL_H_
#undef NACRE_SHADING_MICROFACET_ALBEDO_INL_H_
#else
#define NACRE_SHADING_MICROFACET_ALBEDO_INL_H_
#endif

#include "brdf/anisotropic_albedo-inl.h"
#include "brdf/table_albedo-inl.h"
#include "shading/range-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

// The directional albedo of single scattering is F0 scale + bias.
struct AlbedoV {
  FloatV one, loss;  // the albedo for F = 1, and 1 minus that
  FloatV scale;
  RgbV bias;
};

// The albedo for a dielectric's exact Fresnel curve, of which `fit` is the model's fit, or the fit
// of each hit.
HWY_INLINE RgbV DielectricAlbedo(FloatTag d, const MicrofacetModel& model, const AlbedoFit& fit,
                                 FloatV one, const AlbedoVariablesV<FloatV>& x) {
  if (model.fresnel == FresnelForm::kThinFilm) {
    return TableAlbedo(d, model.film->albedo, fit, model.film->dielectric, one, x);
  }
  if (model.albedo.corner) {
    return Scale(TableReflectance(d, *model.albedo.corner, x.n_dot_v), one);
  }
  return GreyOf(AlbedoFresnel(d, model.albedo, one, x));
}
HWY_INLINE RgbV DielectricAlbedo(FloatTag d, const MicrofacetModel& model,
                                 const AlbedoFitLanes& fit, FloatV one,
                                 const AlbedoVariablesV<FloatV>& x) {
  if (model.fresnel == FresnelForm::kThinFilm) {
    return TableAlbedo(d, model.film->curves, fit, model.film->dielectric, one, x);
  }
  const FloatV one_minus_mu = hn::Sub(hn::Set(d, 1.0f), x.n_dot_v);
  const FloatV mirror = FresnelCoatedDielectric(d, x.n_dot_v, one_minus_mu, model.albedo.curve);
  return GreyOf(AlbedoNearMirror(d, fit, fit.schlick, mirror, one, x));
}

// `with_curve`: whether scale and bias are read.
template <class Fit>
HWY_INLINE AlbedoV EvaluateAlbedo(FloatTag d, const MicrofacetModel& model, const Fit& fit,
                                  FloatV f90, bool with_curve, const AlbedoVariablesV<FloatV>& x) {
  const FloatV one = AlbedoOne(d, fit, x);
  // The branch selects vectors, not structs, because GCC would pass a struct through memory.
  FloatV scale = hn::Zero(d), red = scale, green = scale, blue = scale;
  if (!with_curve) {
  } else if (HasExactCurve(model.fresnel)) {
    const RgbV exact = DielectricAlbedo(d, model, fit, one, x);
    red = exact.x, green = exact.y, blue = exact.z;
  } else {
    const FloatV schlick = AlbedoSchlick(d, fit, one, x);
    scale = hn::Sub(one, schlick);
    red = green = blue = hn::Mul(f90, schlick);
  }
  return {one, AlbedoLoss(d, fit, x), scale, {red, green, blue}};
}

// LobeCosines of a packet of hits.
struct LobeCosinesV {
  FloatV n, t, b;
};

HWY_INLINE AlbedoV EvaluateAlbedo(FloatTag d, const MicrofacetModel& model,
                                  const AnisotropicLobe& lobe, FloatV f90, const LobeCosinesV& at) {
  const auto x = ComputeAlbedoVariables(d, lobe.albedo.shape, at.n, at.t, at.b);
  const FloatV loss = AlbedoLoss(d, lobe.albedo, x);
  const FloatV one = hn::Sub(hn::Set(d, 1.0f), loss);
  if (model.fresnel == FresnelForm::kThinFilm) {
    return {one, loss, hn::Zero(d), TableAlbedo(d, lobe.fresnel, model.film->dielectric, one, x)};
  }
  if (HasExactCurve(model.fresnel)) {
    const FloatV below_one = hn::Sub(hn::Set(d, 1.0f), x.n_dot_x);
    const FloatV mirror = FresnelCoatedDielectric(d, x.n_dot_x, below_one, model.albedo.curve);
    return {one, loss, hn::Zero(d), GreyOf(AlbedoFresnel(d, lobe.fresnel[0], one, mirror, x))};
  }
  const FloatV schlick = AlbedoSchlick(d, lobe.albedo, one, x);
  return {one, loss, hn::Sub(one, schlick), GreyOf(hn::Mul(f90, schlick))};
}

// The same of hits i..., which share a lobe or have one each: the latter have a table each, whose
// lanes are evaluated one by one.
HWY_INLINE AlbedoV EvaluateAlbedo(FloatTag d, const MicrofacetModel& model,
                                  const AnisotropicLobes& lobes, size_t i, FloatV f90,
                                  const LobeCosinesV& at) {
  if (lobes.stride == 0) return EvaluateAlbedo(d, model, *lobes.first, f90, at);
  constexpr size_t kMost = hn::MaxLanes(FloatTag());
  HWY_ALIGN float n[kMost], t[kMost], b[kMost], loss[kMost], curve[3][kMost];
  hn::Store(at.n, d, n);
  hn::Store(at.t, d, t);
  hn::Store(at.b, d, b);
  for (size_t k = 0; k < hn::Lanes(d); ++k) {
    const LobeCosines x(double{n[k]}, double{t[k]}, double{b[k]});
    const LobeAlbedos albedos = AlbedosOfLobe(model, lobes.At(i + k), x);
    loss[k] = static_cast<float>(albedos.loss);
    for (int c = 0; c < 3; ++c) curve[c][k] = static_cast<float>(albedos.curve[c]);
  }
  const FloatV lost = hn::Load(d, loss);
  const RgbV of_curve{hn::Load(d, curve[0]), hn::Load(d, curve[1]), hn::Load(d, curve[2])};
  const FloatV one = hn::Sub(hn::Set(d, 1.0f), lost);
  if (HasExactCurve(model.fresnel)) return {one, lost, hn::Zero(d), of_curve};
  return {one, lost, hn::Sub(one, of_curve.x), GreyOf(hn::Mul(f90, of_curve.x))};
}

// The fits of hits i..., where HitParameters::fit begins at `fits`. Their second curve is Schlick's
// or the dielectric's.
HWY_INLINE AlbedoFitLanes FitAt(const float* fits, size_t i, Shadowing shadowing) {
  constexpr size_t stride = HitParameters::kStride;
  const float* const fit = fits + i;
  AlbedoFitLanes lanes;
  lanes.shape = {fit, fit + stride, fit + 2 * stride, fit + 3 * stride, AlbedoFormOf(shadowing)};
  lanes.one = {fit + 4 * stride, stride};
  lanes.schlick = {fit + (4 + kAlbedoTerms) * stride, stride};
  return lanes;
}

// The variables and the albedo of hits i..., by the model's fit or by that of each hit.
template <class Number>
HWY_INLINE AlbedoVariablesV<FloatV> VariablesAt(FloatTag d,
                                                const MicrofacetNumbers<Number>& numbers, size_t i,
                                                FloatV cosine) {
  const MicrofacetModel& model = numbers.model;
  if (numbers.fit == nullptr) return ComputeAlbedoVariables(d, model.albedo.lobe.shape, cosine);
  return ComputeAlbedoVariables(d, FitAt(numbers.fit, i, model.shadowing).shape, cosine);
}
template <class Number>
HWY_INLINE AlbedoV AlbedoAt(FloatTag d, const MicrofacetNumbers<Number>& numbers, size_t i,
                            bool with_curve, const AlbedoVariablesV<FloatV>& x) {
  const MicrofacetModel& model = numbers.model;
  const FloatV f90 = NumberAt(d, numbers.dielectric_f90, i);
  if (numbers.fit == nullptr) {
    return EvaluateAlbedo(d, model, model.albedo.lobe, f90, with_curve, x);
  }
  return EvaluateAlbedo(d, model, FitAt(numbers.fit, i, model.shadowing), f90, with_curve, x);
}

// The albedos of a block of hits in a direction of each, to view or to light. An albedo is a long
// chain of dependent operations, which is cut into several loops as shading is (packets-inl.h).
struct AlbedoBlock {
  static constexpr size_t kHits = 256;  // a multiple of every target's lanes
  alignas(64) float z[kHits], cosine[kHits], factor[kHits];
  alignas(64) float one[kHits], loss[kHits], scale[kHits], bias[3][kHits];
  bool with_curve;  // whether scale and bias are stored; else they are read as 0

  HWY_INLINE void Store(FloatTag d, size_t at, const AlbedoVariablesV<FloatV>& x) {
    hn::Store(x.z, d, z + at);
    hn::Store(x.n_dot_v, d, cosine + at);
    hn::Store(x.factor, d, factor + at);
  }
  HWY_INLINE AlbedoVariablesV<FloatV> Variables(FloatTag d, size_t at) const {
    return {hn::Load(d, z + at), hn::Load(d, cosine + at), hn::Load(d, factor + at)};
  }
  HWY_INLINE void Store(FloatTag d, size_t at, const AlbedoV& albedo) {
    hn::Store(albedo.one, d, one + at);
    hn::Store(albedo.loss, d, loss + at);
    if (!with_curve) return;
    hn::Store(albedo.scale, d, scale + at);
    hn::Store(albedo.bias.x, d, bias[0] + at);
    hn::Store(albedo.bias.y, d, bias[1] + at);
    hn::Store(albedo.bias.z, d, bias[2] + at);
  }
  HWY_INLINE AlbedoV Albedo(FloatTag d, size_t at) const {
    FloatV of_f0 = hn::Zero(d), red = of_f0, green = of_f0, blue = of_f0;
    if (with_curve) {
      of_f0 = hn::Load(d, scale + at);
      red = hn::Load(d, bias[0] + at), green = hn::Load(d, bias[1] + at);
      blue = hn::Load(d, bias[2] + at);
    }
    return {hn::Load(d, one + at), hn::Load(d, loss + at), of_f0, {red, green, blue}};
  }
};

// Fills a block with the albedos of isotropic lobes of hits [begin, end); cosine_at(i) is the angle
// of the directions of hits i...
template <class Number, class CosineAt>
HWY_INLINE void FillAlbedos(const MicrofacetNumbers<Number>& numbers, size_t begin, size_t end,
                            const CosineAt& cosine_at, AlbedoBlock* block) {
  const FloatTag d;
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    block->Store(d, i - begin, VariablesAt(d, numbers, i, cosine_at(i)));
  }
  const bool with_curve = block->with_curve;
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    block->Store(d, i - begin, AlbedoAt(d, numbers, i, with_curve, block->Variables(d, i - begin)));
  }
}

// The same of anisotropic lobes, which are few; at(i) are LobeCosinesV.
template <class Number, class CosinesAt>
HWY_INLINE void FillAnisotropic(const MicrofacetNumbers<Number>& numbers, size_t begin, size_t end,
                                const CosinesAt& at, AlbedoBlock* block) {
  const FloatTag d;
  for (size_t i = begin; i < end; i += hn::Lanes(d)) {
    const FloatV f90 = NumberAt(d, numbers.dielectric_f90, i);
    block->Store(d, i - begin, EvaluateAlbedo(d, numbers.model, numbers.lobes, i, f90, at(i)));
  }
}

// 1 minus the albedo of the whole lobe, including Kulla and Conty's lobe: the fraction of the light
// from that direction that reaches the base or, equally, that gets from the base to that direction.
// `bias` is a channel of AlbedoV's, `cover` a factor on the albedo (MicrofacetModel::cover).
// Clamped, because rounding may make it negative where nothing is left.
HWY_INLINE FloatV KullaContyBase(FloatTag d, const AlbedoV& albedo, FloatV bias, FloatV f0,
                                 FloatV f_multiple, FloatV cover) {
  const FloatV one = hn::Set(d, 1.0f);
  const FloatV single = hn::MulAdd(f0, albedo.scale, bias);
  const FloatV whole = hn::MulAdd(f_multiple, albedo.loss, single);
  return hn::Max(hn::NegMulAdd(cover, whole, one), hn::Zero(d));
}

// KullaContyBase, but with Turquin's scale on the lobe, where `multiple` = 1 / E - 1.
HWY_INLINE FloatV TurquinBase(FloatTag d, const AlbedoV& albedo, FloatV bias, FloatV f0,
                              FloatV multiple, FloatV cover) {
  const FloatV one = hn::Set(d, 1.0f);
  const FloatV single = hn::MulAdd(f0, albedo.scale, bias);
  const FloatV whole = hn::Mul(single, hn::MulAdd(f0, multiple, one));
  return hn::Max(hn::NegMulAdd(cover, whole, one), hn::Zero(d));
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
