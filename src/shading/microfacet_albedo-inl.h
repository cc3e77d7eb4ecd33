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

#include "brdf/albedo-inl.h"
#include "shading/range-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

// The directional albedo of single scattering is F0 scale + bias.
struct AlbedoV {
  FloatV one, loss;  // the albedo for F = 1, and 1 minus that
  FloatV scale, bias;
};

// The albedo for a dielectric's exact Fresnel curve, of which `fit` is the model's fit, or the fit
// of each hit.
HWY_INLINE FloatV DielectricAlbedo(FloatTag d, const MicrofacetModel& model, const AlbedoFit&,
                                   FloatV one, const AlbedoVariablesV<FloatV>& x) {
  return AlbedoFresnel(d, model.albedo, one, x);
}
HWY_INLINE FloatV DielectricAlbedo(FloatTag d, const MicrofacetModel& model,
                                   const AlbedoFitLanes& fit, FloatV one,
                                   const AlbedoVariablesV<FloatV>& x) {
  const FloatV eta = hn::Set(d, static_cast<float>(model.eta.x));
  const FloatV one_minus_mu = hn::Sub(hn::Set(d, 1.0f), x.n_dot_v);
  const FloatV mirror = FresnelDielectric(d, x.n_dot_v, one_minus_mu, eta);
  return AlbedoNearMirror(d, fit, fit.schlick, mirror, one, x);
}

template <class Fit>
HWY_INLINE AlbedoV EvaluateAlbedo(FloatTag d, const MicrofacetModel& model, const Fit& fit,
                                  FloatV f90, const AlbedoVariablesV<FloatV>& x) {
  const FloatV one = AlbedoOne(d, fit, x);
  // The branch selects vectors, not structs, because GCC would pass a struct through memory.
  FloatV scale, bias;
  if (model.fresnel == FresnelForm::kDielectric) {
    scale = hn::Zero(d);
    bias = DielectricAlbedo(d, model, fit, one, x);
  } else {
    const FloatV schlick = AlbedoSchlick(d, fit, one, x);
    scale = hn::Sub(one, schlick);
    bias = hn::Mul(f90, schlick);
  }
  return {one, AlbedoLoss(d, fit, x), scale, bias};
}

// EvaluateAlbedo from n.v, or n.l, alone.
template <class Fit>
HWY_INLINE AlbedoV EvaluateAlbedo(FloatTag d, const MicrofacetModel& model, const Fit& fit,
                                  FloatV f90, FloatV cosine) {
  return EvaluateAlbedo(d, model, fit, f90, ComputeAlbedoVariables(d, fit.shape, cosine));
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

// 1 minus the albedo of the whole lobe, including Kulla and Conty's lobe: the fraction of the light
// from that direction that reaches the base or, equally, that gets from the base to that direction.
// Clamped, because rounding may make it negative where nothing is left.
HWY_INLINE FloatV KullaContyBase(FloatTag d, const AlbedoV& albedo, FloatV f0, FloatV f_multiple) {
  const FloatV one = hn::Set(d, 1.0f);
  const FloatV single = hn::MulAdd(f0, albedo.scale, albedo.bias);
  const FloatV whole = hn::MulAdd(f_multiple, albedo.loss, single);
  return hn::Max(hn::Sub(one, whole), hn::Zero(d));
}

// KullaContyBase, but with Turquin's scale on the lobe, where `multiple` = 1 / E - 1.
HWY_INLINE FloatV TurquinBase(FloatTag d, const AlbedoV& albedo, FloatV f0, FloatV multiple) {
  const FloatV one = hn::Set(d, 1.0f);
  const FloatV single = hn::MulAdd(f0, albedo.scale, albedo.bias);
  const FloatV whole = hn::Mul(single, hn::MulAdd(f0, multiple, one));
  return hn::Max(hn::Sub(one, whole), hn::Zero(d));
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
