// brdf/fresnel-inl.h: Fresnel terms on SIMD vectors. Scalar twin: brdf/fresnel.h.
#if defined(NACRE_BRDF_FRESNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_FRESNEL_INL_H_
#undef NACRE_BRDF_FRESNEL_INL_H_
#else
#define NACRE_BRDF_FRESNEL_INL_H_
#endif

#include "brdf/angles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// (1 - v.h)^5 of Schlick 1994, with 1 - v.h free of cancellation.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V SchlickWeight(D d, const AnglesV<V>& a) {
  using T = hn::TFromD<D>;
  const V denominator = hn::MulAdd(hn::Set(d, T(2)), hn::Sqrt(a.u_squared), hn::Set(d, T(4)));
  const V ratio = hn::Div(a.lv_squared, denominator);
  const V one_minus_vh = hn::Min(ratio, hn::Set(d, T(1)));
  const V squared = hn::Mul(one_minus_vh, one_minus_vh);
  return hn::Mul(hn::Mul(squared, squared), one_minus_vh);
}

// F0 + (1 - F0) weight.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V FresnelSchlick(D d, V f0, V schlick_weight) {
  return hn::MulAdd(hn::Sub(hn::Set(d, hn::TFromD<D>(1)), f0), schlick_weight, f0);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
