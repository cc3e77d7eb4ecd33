// SPDX-License-Identifier: Apache-2.0
// brdf/coat-inl.h: clear coat on SIMD vectors of floats or doubles. Scalar twin: brdf/coat.h.
#if defined(NACRE_BRDF_COAT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_COAT_INL_H_
#undef NACRE_BRDF_COAT_INL_H_
#else
#define NACRE_BRDF_COAT_INL_H_
#endif

#include "brdf/albedo-inl.h"
#include "brdf/fresnel-inl.h"
#include "brdf/ggx-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// F(v.h) D V; 0 unless n.l > 0 and n.v >= 0, and for delta lobes.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V CoatLobe(D d, const AnglesV<V>& a, V f0, V alpha) {
  using T = hn::TFromD<D>;
  const V zero = hn::Zero(d), one = hn::Set(d, T(1));
  const auto above = hn::And(hn::Gt(a.n_dot_l, zero), hn::Ge(a.n_dot_v, zero));
  const auto shown = hn::And(above, hn::Ge(alpha, hn::Set(d, T(0x1p-40))));
  const V n_dot_l = hn::IfThenElse(shown, a.n_dot_l, one);
  const V n_dot_v = hn::IfThenElse(shown, a.n_dot_v, one);
  const V width = hn::IfThenElse(shown, alpha, one);
  const V fresnel = FresnelSchlick(d, f0, one, SchlickWeight(d, a));
  const V below = VisibilityDenominatorHeightCorrelated(d, n_dot_l, n_dot_v, width, one);
  const V lobe = hn::Div(hn::Mul(fresnel, GgxDistribution(d, a, width)), below);
  return hn::IfThenElseZero(shown, lobe);
}

// The directional albedo, of a material's AlbedoFit or of AlbedoFitLanes.
template <class D, class Fit, class V = hn::Vec<D>>
HWY_INLINE V CoatAlbedo(D d, const Fit& fit, V f0, V n_dot_v) {
  const AlbedoVariablesV<V> x = ComputeAlbedoVariables(d, fit.shape, n_dot_v);
  const V e = AlbedoOne(d, fit, x);
  const V one_minus_f0 = hn::Sub(hn::Set(d, hn::TFromD<D>(1)), f0);
  return hn::MulAdd(f0, e, hn::Mul(one_minus_f0, AlbedoSchlick(d, fit, e, x)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V ScaleBelowCoat(D d, V amount, V albedo_v) {
  return hn::NegMulAdd(amount, albedo_v, hn::Set(d, hn::TFromD<D>(1)));
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
