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
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// 1 / (constant + linear d + quadratic d^2), or 0 at the light itself.
template <class D, class T = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_INLINE V AttenuationFactor(D d, const AttenuationTerms<T>& a, V distance) {
  const V slope = hn::MulAdd(hn::Set(d, a.quadratic), distance, hn::Set(d, a.linear));
  const V denominator = hn::MulAdd(slope, distance, hn::Set(d, a.constant));
  const V zero = hn::Zero(d);
  const auto lit = hn::And(hn::Gt(denominator, zero), hn::Gt(distance, zero));
  const V one = hn::Set(d, T(1));
  return hn::IfThenElseZero(lit, hn::Div(one, hn::IfThenElse(lit, denominator, one)));
}

// The penumbra's t, in double, because next to the cutoff it is the difference of two nearly equal
// angles.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V PenumbraParameter(D d, const ConeTerms<double>& cone, V one_minus_cos) {
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0);
  const V cutoff = hn::Set(d, cone.cutoff);
  const auto lit = hn::Lt(one_minus_cos, cutoff);
  if (!(cone.inner < cone.cutoff)) return hn::IfThenElseZero(lit, one);
  const V t = hn::Div(hn::Sub(cutoff, one_minus_cos), hn::Set(d, cone.cutoff - cone.inner));
  return hn::Min(hn::Max(t, zero), one);
}

// The spot's factor, from t and from 1 - cos and cos of the angle, which were computed in double.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V SpotFactor(D d, const ConeTerms<double>& cone, V t, V one_minus_cos, V cosine) {
  const auto constant = [&](double value)
                            HWY_ATTR { return hn::Set(d, static_cast<float>(value)); };
  const V line = hn::MulAdd(constant(cone.edge[1]), t, constant(cone.edge[0]));
  const V edge = hn::Mul(hn::Mul(t, t), line);
  if (cone.exponent == 0) return edge;
  const V log2 = Log2OneMinus(d, one_minus_cos, cosine);
  const auto positive = hn::Gt(cosine, hn::Zero(d));
  return hn::IfThenElseZero(
      positive,
      hn::Mul(edge, Exp2(d, hn::Mul(constant(cone.exponent), hn::IfThenElseZero(positive, log2)))));
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
