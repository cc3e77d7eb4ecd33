// SPDX-License-Identifier: Apache-2.0
// base/math-inl.h: polynomials, and base-2 logarithm and exponential on float vectors, for powers
// with real exponents: x^n = Exp2(n Log2(x)). Highway's contrib has natural ones, which take twice
// as long, and its log1p is inaccurate for cosines near 0. Also the power of two in a number, by
// which scaling is exact.
//
// Coefficients: scripts/fit_math.py prints them with their errors.
#if defined(NACRE_BASE_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BASE_MATH_INL_H_
#undef NACRE_BASE_MATH_INL_H_
#else
#define NACRE_BASE_MATH_INL_H_
#endif

#include <cstdint>
#include <type_traits>

#include "base/target_ops-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The polynomial in x with these coefficients, lowest first, by Horner's rule.
template <class D, size_t kTerms, class V = hn::Vec<D>>
HWY_INLINE V EvaluatePolynomial(D d, const float (&coefficients)[kTerms], V x) {
  V p = hn::Set(d, coefficients[kTerms - 1]);
  for (size_t i = kTerms - 1; i != 0; --i) p = hn::MulAdd(p, x, hn::Set(d, coefficients[i - 1]));
  return p;
}

// A polynomial in x of kTerms terms, an even number; coefficient(i) is that of x^i. Even and odd
// powers are summed separately by Horner's rule: two chains of dependent operations, each half as
// long.
template <size_t kTerms, class V, class Coefficient>
HWY_INLINE V EvaluateEvenOdd(const Coefficient& coefficient, V x) {
  static_assert(kTerms % 2 == 0);
  const V x2 = hn::Mul(x, x);
  V last = coefficient(kTerms - 1), before = coefficient(kTerms - 2);
  for (size_t i = kTerms - 2; i != 0; i -= 2) {
    last = hn::MulAdd(last, x2, coefficient(i - 1));
    before = hn::MulAdd(before, x2, coefficient(i - 2));
  }
  return hn::MulAdd(last, x, before);
}

template <class V>
struct PowerOfTwoV {
  V power, inverse;
};

// For a normal v > 0: the power of two 2^e for which v / 2^e is in [1, 2), and 2^-e, which is 0 for
// the largest e. For v = 0, both are finite.
template <class D, class V = hn::Vec<D>>
HWY_INLINE PowerOfTwoV<V> PowerOfTwo(D d, V v) {
  using Bits = std::conditional_t<sizeof(hn::TFromD<D>) == 4, uint32_t, uint64_t>;
  constexpr Bits kExponent = static_cast<Bits>(sizeof(Bits) == 4 ? 0x7f800000 : 0x7ff0000000000000);
  constexpr Bits kTwiceOne = static_cast<Bits>(sizeof(Bits) == 4 ? 0x7f000000 : 0x7fe0000000000000);
  const hn::Rebind<Bits, D> bits;
  const auto exponent = hn::And(hn::BitCast(bits, v), hn::Set(bits, kExponent));
  return {hn::BitCast(d, exponent), hn::BitCast(d, hn::Sub(hn::Set(bits, kTwiceOne), exponent))};
}

// log2(1 + f) for f in [sqrt(1/2) - 1, sqrt(2) - 1]: relative error 2e-8 before rounding.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Log2OnePlusPolynomial(D d, V f) {
  constexpr float kCoefficients[] = {1.44269502f,  -0.721347332f, 0.480898529f, -0.360696554f,
                                     0.288552552f, -0.239608124f, 0.204857647f, -0.191388384f,
                                     0.184760332f, -0.107497893f};
  const auto coefficient = [&](size_t i) HWY_ATTR { return hn::Set(d, kCoefficients[i]); };
  return hn::Mul(EvaluateEvenOdd<10>(coefficient, f), f);
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

// log2(x) for normal x > 0: relative error 2e-7, except near x = 1, where the error is absolute.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Log2(D d, V x) {
  V f, exponent;
  SplitExponent(d, x, &f, &exponent);
  return hn::Add(Log2OnePlusPolynomial(d, f), exponent);
}

// log2(1 - x) by tables (after Tang 1990). For c = 2^(e + 1) m, one of 16 numbers s near 1 / m
// makes s m = 1 + f with |f| <= 1/32. Then log2(c) = e + (1 - log2(s)) + log2(1 + f), where the
// first two terms cancel near c = 1, where s = 1. The other s are floats chosen so that 1 - log2(s)
// has a rounding error of at most 2^-36 (Gal 1986), and f = s (m - 1) + (s - 1) is rounded only
// once.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Log2OneMinusByTables(D d, V x, V c) {
  alignas(64) static constexpr float kScale[] = {1.93938172f, 1.8283602f,  1.72939241f, 1.64100206f,
                                                 1.56090307f, 1.48836052f, 1.42248714f, 1.36151564f,
                                                 1.30610323f, 1.25497186f, 1.20789838f, 1.16394758f,
                                                 1.12251043f, 1.08502173f, 1.04914939f, 1.0f};
  alignas(64) static constexpr float kOneMinusLog2[] = {
      0.0444032103f, 0.12944968f,  0.209734738f, 0.285422951f, 0.357619047f, 0.426275969f,
      0.49158439f,   0.554786444f, 0.614731073f, 0.672344983f, 0.727500916f, 0.780973911f,
      0.833271146f,  0.882276058f, 0.930779874f, 1.0f};
  constexpr float kCoefficients[] = {1.44269502f, -0.721347272f, 0.481172562f, -0.361393839f};
  constexpr int kFirstOfMantissa = 19;
  const V one = hn::Set(d, 1.0f);
  const V below_one = hn::Min(c, hn::Set(d, 1 - 0x1p-24f));  // 1 itself would have another exponent
  const V s = LookUp16<kFirstOfMantissa>(kScale, below_one);
  const auto small = hn::Lt(x, hn::Set(d, 0.25f));  // there, m = c
  const V m_minus_1 =
      hn::IfThenElse(small, hn::Sub(hn::Zero(d), x), hn::Sub(HalfMantissa(below_one), one));
  const V f = hn::MulAdd(s, m_minus_1, hn::Sub(s, one));
  const V whole =
      hn::Add(Exponent(below_one), LookUp16<kFirstOfMantissa>(kOneMinusLog2, below_one));
  return hn::MulAdd(EvaluatePolynomial(d, kCoefficients, f), f, whole);
}

// 2^y = 2^w 2^(k / 16) 2^f with |f| <= 1/32.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Exp2ByTable(D d, V y) {
  alignas(64) static constexpr float kRoots[] = {
      1.0f,        1.04427373f, 1.09050775f, 1.13878858f, 1.18920708f, 1.24185777f,
      1.29683959f, 1.35425556f, 1.41421354f, 1.47682619f, 1.54221082f, 1.61049032f,
      1.68179286f, 1.75625217f, 1.8340081f,  1.91520655f};
  // The rounding errors of the entries in kRoots.
  alignas(64) static constexpr float kRootLows[] = {0.0f,
                                                    4.83347016e-08f,
                                                    -1.30775399e-08f,
                                                    5.38622231e-08f,
                                                    3.79763527e-08f,
                                                    4.4968381e-08f,
                                                    -4.01899953e-08f,
                                                    -1.01233493e-08f,
                                                    2.4203235e-08f,
                                                    -4.50089885e-08f,
                                                    8.07090483e-09f,
                                                    9.83621717e-09f,
                                                    -2.47553267e-08f,
                                                    -9.23577037e-09f,
                                                    -1.1239278e-08f,
                                                    9.84532811e-09f};
  // (2^f - 1) / f.
  constexpr float kCoefficients[] = {0.693147182f, 0.240233555f, 0.0555050857f};
  // Adding 1.5 2^19 rounds to the nearest sixteenth; k is then in the sum's last four bits.
  const V shifter = hn::Set(d, 0x1.8p19f);
  const V shifted = hn::Add(y, shifter);
  const V rounded = hn::Sub(shifted, shifter);
  const V f = hn::Sub(y, rounded);
  const V root = LookUp16<0>(kRoots, shifted);
  const V p = EvaluatePolynomial(d, kCoefficients, f);
  const V low = hn::MulAdd(hn::Mul(root, f), p, LookUp16<0>(kRootLows, shifted));
  return TimesPowerOf2(hn::Add(root, low), rounded);
}

// log2(1 - x) for x in [0, 1), given x and c = 1 - x, of which the accurate one is used: x if it is
// small. Relative error 2e-7 everywhere. For c <= 0 the result is finite, -infinity or NaN.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Log2OneMinus(D d, V x, V c) {
  if constexpr (kSplitsFloats<V>) return Log2OneMinusByTables(d, x, c);
  V f, exponent;
  SplitExponent(d, c, &f, &exponent);
  const auto small = hn::Lt(x, hn::Set(d, 0.25f));  // well within the polynomial's range
  f = hn::IfThenElse(small, hn::Neg(x), f);
  return hn::Add(Log2OnePlusPolynomial(d, f), hn::IfThenZeroElse(small, exponent));
}

// 2^y for finite y < 128: relative error 1e-7. Below -126, where it is denormal, the result is 0;
// on AVX-512 that depends on the processor's mode.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Exp2(D d, V y) {
  if constexpr (kSplitsFloats<V>) return Exp2ByTable(d, y);
  constexpr float kCoefficients[] = {1.0f,           0.693147182f,  0.240226507f,   0.0555032715f,
                                     0.00961805694f, 0.0013400428f, 0.000154614449f};
  const hn::RebindToSigned<D> di;
  // Below -126, and for NaN: -127, for which all bits of the result are 0.
  const V clamped = hn::IfThenElse(hn::Gt(y, hn::Set(d, -126.0f)), y, hn::Set(d, -127.0f));
  // Adding 1.5 2^23 rounds to the nearest whole number, which is then in the sum's last bits.
  const V shifter = hn::Set(d, 0x1.8p23f);
  const V shifted = hn::Add(clamped, shifter);
  const V f = hn::Sub(clamped, hn::Sub(shifted, shifter));
  // EvaluateEvenOdd would have a rounding error twice as large.
  const V p = EvaluatePolynomial(d, kCoefficients, f);
  const auto bits = hn::Add(hn::BitCast(di, p), hn::ShiftLeft<23>(hn::BitCast(di, shifted)));
  return hn::BitCast(d, bits);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
