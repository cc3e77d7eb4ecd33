// SPDX-License-Identifier: Apache-2.0
// base/trig-inl.h: sine, cosine and arc tangent on float vectors. Scalar twins of the functions
// that the standard library lacks: trig.h.
//
// Coefficients: scripts/fit_math.py prints them with their errors.
#if defined(NACRE_BASE_TRIG_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BASE_TRIG_INL_H_
#undef NACRE_BASE_TRIG_INL_H_
#else
#define NACRE_BASE_TRIG_INL_H_
#endif

#include "base/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct SinCosV {
  V sin, cos;
};

// The nearest whole number of |x| < 2^22.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V RoundToNearest(D d, V x) {
  const V shifter = hn::Set(d, 0x1.8p23f);  // the sum's last bit is 1
  return hn::Sub(hn::Add(x, shifter), shifter);
}

// Sine and cosine of 2 pi u, |u| < 2^22: relative error 3e-7, also next to their zeros, because the
// reduction to a quarter turn is exact.
template <class D, class V = hn::Vec<D>>
HWY_INLINE SinCosV<V> SinCosTurns(D d, V u) {
  constexpr float kSine[] = {1.57079637f, -0.645964086f, 0.0796925798f, -0.00468126638f,
                             0.000158206298f};
  constexpr float kCosine[] = {1.0f, -1.23370051f, 0.253669202f, -0.0208600704f, 0.000903628068f};
  const V one = hn::Set(d, 1.0f);
  // u in quarter turns in [-2, 2], exactly, split into the nearest integer and a fraction.
  const V quarters = hn::Mul(hn::Sub(u, RoundToNearest(d, u)), hn::Set(d, 4.0f));
  const V whole = RoundToNearest(d, quarters);
  const V f = hn::Sub(quarters, whole);
  const V z = hn::Mul(f, f);
  const V sine = hn::Mul(f, EvaluatePolynomial(d, kSine, z));
  const V cosine = EvaluatePolynomial(d, kCosine, z);
  const auto odd = hn::Eq(hn::Abs(whole), one);
  const V even_sign = hn::Sub(one, hn::Abs(whole));  // 1 at 0, -1 at 2 quarters
  return {
      hn::Mul(hn::IfThenElse(odd, cosine, sine), hn::IfThenElse(odd, whole, even_sign)),
      hn::Mul(hn::IfThenElse(odd, sine, cosine), hn::IfThenElse(odd, hn::Neg(whole), even_sign))};
}

// (x - atan x) / x^3 for 0 <= x <= 1, as a polynomial in z = x^2: relative error 1e-7 before
// rounding.
inline constexpr float kAtanRemainder[] = {0.333333313f,  -0.199997395f,  0.142785683f,
                                           -0.110337645f, 0.0865688026f,  -0.0625016913f,
                                           0.0358715393f, -0.0135077713f, 0.00238699722f};

template <class D, class V = hn::Vec<D>>
HWY_INLINE V AtanRemainderPolynomial(D d, V z) {
  return EvaluatePolynomial(d, kAtanRemainder, z);
}

// (x - atan x) / x^3 for x >= 0 with normal x^2 if x > 1: relative error 1e-6.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V AtanRemainder(D d, V x) {
  const V one = hn::Set(d, 1.0f);
  const auto large = hn::Gt(x, one);
  const V inverse = hn::Div(one, hn::IfThenElse(large, x, one));
  const V t = hn::IfThenElse(large, inverse, x);
  const V z = hn::Mul(t, t);
  const V remainder = AtanRemainderPolynomial(d, z);
  // atan x = pi/2 - atan t, and 1 / x^2 = t^2.
  const V atan_t = hn::NegMulAdd(hn::Mul(t, z), remainder, t);
  const V atan_x = hn::Sub(hn::Set(d, 1.57079633f), atan_t);
  return hn::IfThenElse(large, hn::Mul(z, hn::NegMulAdd(atan_x, t, one)), remainder);
}

// The angle of (x, y), y >= 0, in [0, pi]; 0 for (0, 0). Relative error 3e-7.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Atan2Upper(D d, V y, V x) {
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  const V size = hn::Abs(x);
  const auto steep = hn::Gt(y, size);
  const V larger = hn::Max(y, size);
  const V t = hn::Div(hn::Min(y, size), hn::IfThenElse(hn::Gt(larger, zero), larger, one));
  const V z = hn::Mul(t, t);
  const V atan_t = hn::NegMulAdd(hn::Mul(t, z), AtanRemainderPolynomial(d, z), t);
  const V first = hn::IfThenElse(steep, hn::Sub(hn::Set(d, 1.57079633f), atan_t), atan_t);
  return hn::IfThenElse(hn::Lt(x, zero), hn::Sub(hn::Set(d, 3.14159265f), first), first);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
