// SPDX-License-Identifier: Apache-2.0
// brdf/ggx-inl.h: GGX microfacet terms on SIMD vectors. Scalar twin: brdf/ggx.h.
#if defined(NACRE_BRDF_GGX_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_GGX_INL_H_
#undef NACRE_BRDF_GGX_INL_H_
#else
#define NACRE_BRDF_GGX_INL_H_
#endif

#include <cmath>

#include "base/target_ops-inl.h"
#include "brdf/angles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// |u|^2 q, where q = sin^2 + alpha^2 cos^2 of the half vector's angle, at least alpha^2. A kernel
// that merges its divisions computes the distribution from it: alpha^2 |u|^4 / (pi (|u|^2 q)^2).
// There is no test for h below the surface.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V GgxRootDenominator(D, const HalfAnglesV<V>& a, V alpha) {
  const V scaled = hn::Mul(a.n_dot_u, alpha);
  return hn::MulAdd(scaled, scaled, a.nxu_squared);
}

// Walter et al. 2007, eq. 33. alpha must not be a delta lobe's. 0 where h lies below the surface.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V GgxDistribution(D d, const HalfAnglesV<V>& a, V alpha) {
  const V zero = hn::Zero(d);
  const V denominator = GgxRootDenominator(d, a, alpha);
  const auto above = hn::And(hn::Gt(a.n_dot_u, zero), hn::Gt(denominator, zero));
  const V k = hn::Div(hn::Mul(alpha, a.u_squared),
                      hn::IfThenElse(above, denominator, hn::Set(d, hn::TFromD<D>(1))));
  const V squared = hn::Mul(hn::Mul(k, k), hn::Set(d, hn::TFromD<D>(M_1_PI)));
  return hn::IfThenElseZero(above, squared);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V SmithRoot(D d, V n_dot_x, V alpha) {
  const V alpha2 = hn::Mul(alpha, alpha);
  const V one = hn::Set(d, hn::TFromD<D>(1));
  return SquareRoot(d, hn::MulAdd(hn::Mul(n_dot_x, n_dot_x), hn::Sub(one, alpha2), alpha2));
}

// The denominators of the visibility terms times `scale`, so that a kernel can merge its divisions.
// Heitz 2014, eq. 99.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V VisibilityDenominatorHeightCorrelated(D d, V n_dot_l, V n_dot_v, V alpha, V scale) {
  const V sum = hn::MulAdd(n_dot_l, SmithRoot(d, n_dot_v, alpha),
                           hn::Mul(n_dot_v, SmithRoot(d, n_dot_l, alpha)));
  return hn::Mul(sum, hn::Add(scale, scale));
}

// Walter et al. 2007, eq. 34.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V VisibilityDenominatorSeparable(D d, V n_dot_l, V n_dot_v, V alpha, V scale) {
  return hn::Mul(hn::Mul(hn::Add(n_dot_l, SmithRoot(d, n_dot_l, alpha)),
                         hn::Add(n_dot_v, SmithRoot(d, n_dot_v, alpha))),
                 scale);
}

// Karis 2013, k = SchlickK.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V VisibilityDenominatorSchlick(D d, V n_dot_l, V n_dot_v, V k, V scale) {
  const V one_minus_k = hn::Sub(hn::Set(d, hn::TFromD<D>(1)), k);
  // Most of these factors are constants that all hits share.
  const V scale4 = hn::Mul(hn::Set(d, hn::TFromD<D>(4)), scale);
  return hn::Mul(hn::MulAdd(n_dot_l, one_minus_k, k),
                 hn::MulAdd(n_dot_v, hn::Mul(scale4, one_minus_k), hn::Mul(scale4, k)));
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
