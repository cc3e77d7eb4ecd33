// SPDX-License-Identifier: Apache-2.0
// light/punctual-inl.h: fall-off of point and spot lights on SIMD vectors. Scalar twin:
// light/punctual.h.
#if defined(NACRE_LIGHT_PUNCTUAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_LIGHT_PUNCTUAL_INL_H_
#undef NACRE_LIGHT_PUNCTUAL_INL_H_
#else
#define NACRE_LIGHT_PUNCTUAL_INL_H_
#endif

#include "base/math-inl.h"
#include "light/punctual.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// 1 / (constant + linear d + quadratic d^2), 0 at the light itself.
template <class D, class T = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_INLINE V AttenuationFactor(D d, const AttenuationTerms<T>& a, V distance) {
  const V slope = hn::MulAdd(hn::Set(d, a.quadratic), distance, hn::Set(d, a.linear));
  const V denominator = hn::MulAdd(slope, distance, hn::Set(d, a.constant));
  const V zero = hn::Zero(d);
  const auto lit = hn::And(hn::Gt(denominator, zero), hn::Gt(distance, zero));
  const V one = hn::Set(d, T(1));
  return hn::IfThenElseZero(lit, hn::Div(one, hn::IfThenElse(lit, denominator, one)));
}

// Cone with exponent and penumbra; equality with the cutoff is dark.
template <class D, class T = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_INLINE V SpotFactor(D d, const ConeTerms<T>& cone, V cos_angle) {
  const V one = hn::Set(d, T(1));
  const V cutoff = hn::Set(d, cone.cos_cutoff);
  V factor = one;
  if (cone.exponent != T(0)) {
    const auto positive = hn::Gt(cos_angle, hn::Zero(d));
    const V log2 = Log2(d, hn::IfThenElse(positive, cos_angle, one));
    factor = hn::IfThenElseZero(positive, Exp2(d, hn::Mul(hn::Set(d, cone.exponent), log2)));
  }
  if (cone.cos_inner > cone.cos_cutoff) {
    const V inner = hn::Set(d, cone.cos_inner);
    const V t = hn::Div(hn::Sub(cos_angle, cutoff), hn::Sub(inner, cutoff));
    const V line = hn::MulAdd(hn::Set(d, cone.edge[1]), t, hn::Set(d, cone.edge[0]));
    const V edge = hn::Mul(hn::Mul(t, t), line);
    factor = hn::IfThenElse(hn::Lt(cos_angle, inner), hn::Mul(factor, edge), factor);
  }
  return hn::IfThenElseZero(hn::Gt(cos_angle, cutoff), factor);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
