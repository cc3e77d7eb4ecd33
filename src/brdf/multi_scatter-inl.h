// SPDX-License-Identifier: Apache-2.0
// brdf/multi_scatter-inl.h: multiple-scattering terms on SIMD vectors. Scalar twin:
// brdf/multi_scatter.h. Kulla and Conty's are products of AlbedoLoss and a material's constants.
#if defined(NACRE_BRDF_MULTI_SCATTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_MULTI_SCATTER_INL_H_
#undef NACRE_BRDF_MULTI_SCATTER_INL_H_
#else
#define NACRE_BRDF_MULTI_SCATTER_INL_H_
#endif

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Turquin 2019: 1 + F0 (1 / E - 1).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V TurquinFactor(D d, V f0, V albedo_one) {
  const V one = hn::Set(d, hn::TFromD<D>(1));
  return hn::MulAdd(f0, hn::Sub(hn::Div(one, albedo_one), one), one);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
