// SPDX-License-Identifier: Apache-2.0
// base/target_ops-inl.h: the few operations whose fastest accurate form depends on the target.
// It contains nearly all uses of #if HWY_TARGET.
//
// AVX-512 estimates reciprocals to 14 bits, and one Newton step makes them accurate to 1 ulp of a
// float, in a third of the time of a division. Estimates of other targets have 12 bits and would
// need two steps, which are slower than a division.
#if defined(NACRE_BASE_TARGET_OPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BASE_TARGET_OPS_INL_H_
#undef NACRE_BASE_TARGET_OPS_INL_H_
#else
#define NACRE_BASE_TARGET_OPS_INL_H_
#endif

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// 1 / x for normal x of either sign, within 1 ulp; 0 for infinity.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V Reciprocal(D d, V x) {
  const V one = hn::Set(d, hn::TFromD<D>(1));
#if HWY_TARGET <= HWY_AVX3
  if constexpr (sizeof(hn::TFromD<D>) == sizeof(float)) {
    const V estimate = hn::ApproximateReciprocal(x);
    return hn::MulAdd(estimate, hn::NegMulAdd(x, estimate, one), estimate);
  }
#endif
  return hn::Div(one, x);
}

// 1 / sqrt(x) for normal x > 0, within 2 ulp.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V ReciprocalSqrt(D d, V x) {
  const V one = hn::Set(d, hn::TFromD<D>(1));
#if HWY_TARGET <= HWY_AVX3
  if constexpr (sizeof(hn::TFromD<D>) == sizeof(float)) {
    const V estimate = hn::ApproximateReciprocalSqrt(x);
    const V error = hn::NegMulAdd(hn::Mul(x, estimate), estimate, one);
    const V half = hn::Mul(estimate, hn::Set(d, hn::TFromD<D>(0.5)));
    return hn::MulAdd(half, error, estimate);
  }
#endif
  return hn::Div(one, hn::Sqrt(x));
}

// sqrt(x) for normal x > 0, within 1 ulp.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V SquareRoot(D d, V x) {
#if HWY_TARGET <= HWY_AVX3
  if constexpr (sizeof(hn::TFromD<D>) == sizeof(float)) {
    const V half = hn::Set(d, hn::TFromD<D>(0.5));
    const V estimate = hn::ApproximateReciprocalSqrt(x);
    const V root = hn::Mul(x, estimate);
    const V error = hn::NegMulAdd(root, hn::Mul(half, estimate), half);
    return hn::MulAdd(root, error, root);
  }
#endif
  (void)d;
  return hn::Sqrt(x);
}

// 1 / sqrt(v) to at least 14 bits, for v within the range of float. AVX-512 has an instruction for
// it, which is several times faster than a square root and a division.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V RoughInverseSqrt(D d, V v) {
#if HWY_TARGET <= HWY_AVX3
  (void)d;
  return V{_mm512_maskz_rsqrt14_pd(0xff, v.raw)};  // GCC 12 warns about the unmasked form
#else
  const hn::Rebind<float, D> df;
  return hn::PromoteTo(d, hn::Div(hn::Set(df, 1.0f), hn::Sqrt(hn::DemoteTo(df, v))));
#endif
}

// 1 / |direction| within 2 ulp, from dd = |direction|^2 of a camera ray, which is well within the
// range of float. One step of fourth order refines the estimate g to double precision:
// 1 / sqrt(dd) = g (1 + e/2 + 3/8 e^2 + 5/16 e^3 + ...) for e = 1 - dd g^2, of which
// |35/128 e^4| < 2^-53 is dropped.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V InverseLength(D d, V dd) {
  const V guess = RoughInverseSqrt(d, dd);
  const V error = hn::NegMulAdd(hn::Mul(dd, guess), guess, hn::Set(d, 1.0));
  V series = hn::MulAdd(error, hn::Set(d, 5.0 / 16), hn::Set(d, 3.0 / 8));
  series = hn::MulAdd(error, series, hn::Set(d, 1.0 / 2));
  return hn::MulAdd(hn::Mul(error, series), guess, guess);
}

// 2 sqrt(x) for normal x > 0, within 2 ulp: one operation and one dependent step fewer.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V TwiceSquareRoot(D d, V x) {
#if HWY_TARGET <= HWY_AVX3
  if constexpr (sizeof(hn::TFromD<D>) == sizeof(float)) {
    const V estimate = hn::ApproximateReciprocalSqrt(x);
    const V root = hn::Mul(x, estimate);
    return hn::Mul(root, hn::NegMulAdd(root, estimate, hn::Set(d, hn::TFromD<D>(3))));
  }
#endif
  (void)d;
  const V root = hn::Sqrt(x);
  return hn::Add(root, root);
}

// Whether the target has one instruction each to split vectors V of floats into exponent and
// mantissa, to scale them by powers of two, and to look up a table of 16 floats. The functions
// below exist only if so.
template <class V>
constexpr bool kSplitsFloats = false;

#if HWY_TARGET <= HWY_AVX3
using FloatsV = hn::Vec<hn::ScalableTag<float>>;
template <>
constexpr bool kSplitsFloats<FloatsV> = true;

// The masked intrinsics are used with full masks because GCC 12 warns of the plain ones.

// The exponent e of |x| = m 2^e, 1 <= m < 2; -infinity for 0.
HWY_INLINE FloatsV Exponent(FloatsV x) { return FloatsV{_mm512_maskz_getexp_ps(0xffff, x.raw)}; }

// Half the mantissa, m / 2, for x > 0; 1 for 0, NaN for x < 0.
HWY_INLINE FloatsV HalfMantissa(FloatsV x) {
  return FloatsV{_mm512_maskz_getmant_ps(0xffff, x.raw, _MM_MANT_NORM_p5_1, _MM_MANT_SIGN_nan)};
}

// x 2^e, e rounded down.
HWY_INLINE FloatsV TimesPowerOf2(FloatsV x, FloatsV e) {
  return FloatsV{_mm512_maskz_scalef_ps(0xffff, x.raw, e.raw)};
}

// table[i], where i is the four bits from kBit on. The table is aligned to a vector.
template <int kBit>
HWY_INLINE FloatsV LookUp16(const float* table, FloatsV bits) {
  __m512i index = _mm512_castps_si512(bits.raw);
  if constexpr (kBit != 0) index = _mm512_maskz_srli_epi32(0xffff, index, kBit);
  return FloatsV{_mm512_maskz_permutexvar_ps(0xffff, index, _mm512_load_ps(table))};
}
#endif

// minuend - from[i] for a vector of floats, computed in double and rounded once.
HWY_INLINE hn::Vec<hn::ScalableTag<float>> SubtractAndRound(hn::ScalableTag<float> d,
                                                            double minuend,
                                                            const double* HWY_RESTRICT from) {
  const hn::ScalableTag<double> dd;
  const auto m = hn::Set(dd, minuend);
  const auto low = hn::Sub(m, hn::LoadU(dd, from));
#if HWY_TARGET == HWY_SCALAR
  return hn::DemoteTo(d, low);
#else
  const hn::Half<hn::ScalableTag<float>> dh;
  const auto high = hn::Sub(m, hn::LoadU(dd, from + hn::Lanes(dd)));
#if HWY_TARGET <= HWY_AVX3
  // hn::Combine clears the upper half first, and no compiler removes that useless instruction.
  const __m512 lower = _mm512_castps256_ps512(hn::DemoteTo(dh, low).raw);
  return hn::Vec<hn::ScalableTag<float>>{_mm512_insertf32x8(lower, hn::DemoteTo(dh, high).raw, 1)};
#else
  return hn::Combine(d, hn::DemoteTo(dh, high), hn::DemoteTo(dh, low));
#endif
#endif
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
