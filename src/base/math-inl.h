// SPDX-License-Identifier: Apache-2.0
// base/math-inl.h: base-2 logarithm and exponential on float vectors, for powers with real
// exponents: x^n = Exp2(n Log2(x)). Highway's contrib has natural ones, twice as slow, and their
// log1p loses a cosine near 0.
//
// Coefficients: scripts/fit_math.py prints them with their errors.
#if defined(NACRE_BASE_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BASE_MATH_INL_H_
#undef NACRE_BASE_MATH_INL_H_
#else
#define NACRE_BASE_MATH_INL_H_
#endif

#include "base/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The polynomial in x of kTerms terms, an even number, whose coefficient(i) is that of x^i: even
// and odd powers each by Horner's rule, two chains of dependent steps half as long as one.
template <size_t kTerms, class V, class Coefficient>
HWY_INLINE V EvaluateByHalves(const Coefficient& coefficient, V x) {
  static_assert(kTerms % 2 == 0);
  const V x2 = hn::Mul(x, x);
  V last = coefficient(kTerms - 1), before = coefficient(kTerms - 2);
  for (size_t i = kTerms - 2; i != 0; i -= 2) {
    last = hn::MulAdd(last, x2, coefficient(i - 1));
    before = hn::MulAdd(before, x2, coefficient(i - 2));
  }
  return hn::MulAdd(last, x, before);
}

// log2(1 + f) for f in [sqrt(1/2) - 1, sqrt(2) - 1]: relative error 2e-8 before rounding.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Log2OnePlusPolynomial(D d, V f) {
  constexpr float kCoefficients[] = {1.44269502f,  -0.721347332f, 0.480898529f, -0.360696554f,
                                     0.288552552f, -0.239608124f, 0.204857647f, -0.191388384f,
                                     0.184760332f, -0.107497893f};
  const auto coefficient = [&](size_t i) HWY_ATTR { return hn::Set(d, kCoefficients[i]); };
  return hn::Mul(EvaluateByHalves<10>(coefficient, f), f);
}

// Splits x > 0 into 2^exponent * (1 + f) with 1 + f in [sqrt(1/2), sqrt(2)).
template <class D, class V = hn::Vec<D>>
HWY_INLINE void SplitExponent(D d, V x, V* f, V* exponent) {
  const hn::RebindToSigned<D> di;
  constexpr int32_t kSqrtHalfBits = 0x3f3504f3;
  const auto bits = hn::BitCast(di, x);
  const auto e = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, kSqrtHalfBits)));
  const V mantissa = hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(e)));
  *f = hn::Sub(mantissa, hn::Set(d, 1.0f));
  *exponent = hn::ConvertTo(d, e);
}

// log2(x) for normal x > 0: relative error 2e-7 but for x near 1, where it is absolute.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Log2(D d, V x) {
  V f, exponent;
  SplitExponent(d, x, &f, &exponent);
  return hn::Add(Log2OnePlusPolynomial(d, f), exponent);
}

// log2(1 - x) for x in [0, 1), given also c = 1 - x: of the two, whichever is free of
// cancellation tells the logarithm. Relative error 2e-7 everywhere.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Log2OneMinus(D d, V x, V c) {
  V f, exponent;
  SplitExponent(d, c, &f, &exponent);
  const auto small = hn::Lt(x, hn::Set(d, 0.25f));  // well within the polynomial's range
  f = hn::IfThenElse(small, hn::Neg(x), f);
  return hn::Add(Log2OnePlusPolynomial(d, f), hn::IfThenZeroElse(small, exponent));
}

// 2^y for y < 128: relative error 1e-7. 0 below -126, where the result would be denormal.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Exp2(D d, V y) {
  constexpr float kCoefficients[] = {1.0f,           0.693147182f,  0.240226507f,   0.0555032715f,
                                     0.00961805694f, 0.0013400428f, 0.000154614449f};
  const hn::RebindToSigned<D> di;
  // Below the lowest, and for NaN: -127, whose power of 2 has all bits 0.
  const V clamped = hn::IfThenElse(hn::Gt(y, hn::Set(d, -126.0f)), y, hn::Set(d, -127.0f));
  // Adding 1.5 2^23 rounds to the nearest whole number, which is then in the sum's last bits.
  const V shifter = hn::Set(d, 0x1.8p23f);
  const V shifted = hn::Add(clamped, shifter);
  const V f = hn::Sub(clamped, hn::Sub(shifted, shifter));
  // Not by halves, which would round its results twice as far.
  V p = hn::Set(d, kCoefficients[6]);
  for (int i = 5; i >= 0; --i) p = hn::MulAdd(p, f, hn::Set(d, kCoefficients[i]));
  const auto bits = hn::Add(hn::BitCast(di, p), hn::ShiftLeft<23>(hn::BitCast(di, shifted)));
  return hn::BitCast(d, bits);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
