// SPDX-License-Identifier: Apache-2.0
// brdf/burley-inl.h: Burley's diffuse term on SIMD vectors. Scalar twin: brdf/burley.h.
#if defined(NACRE_BRDF_BURLEY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_BURLEY_INL_H_
#undef NACRE_BRDF_BURLEY_INL_H_
#else
#define NACRE_BRDF_BURLEY_INL_H_
#endif

#include "brdf/fresnel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = hn::Vec<D>>
HWY_INLINE V BurleyGrazing(D d, V cos) {
  return Power5(hn::Sub(hn::Set(d, hn::TFromD<D>(1)), cos));
}

// pi times BurleyDiffuse, from |u|^2, u = l + v, and BurleyGrazing of both cosines.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V BurleySpread(D d, V u_squared, V grazing_l, V grazing_v, V roughness) {
  using T = hn::TFromD<D>;
  const V one = hn::Set(d, T(1));
  const V rise = hn::Mul(hn::Set(d, T(0.5)), hn::MulSub(roughness, u_squared, one));
  return hn::Mul(hn::MulAdd(rise, grazing_l, one), hn::MulAdd(rise, grazing_v, one));
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
