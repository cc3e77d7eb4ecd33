// SPDX-License-Identifier: Apache-2.0
// visibility/inverse_length-inl.h: the reciprocal of the length of a camera ray's direction.
#if defined(NACRE_VISIBILITY_INVERSE_LENGTH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_INVERSE_LENGTH_INL_H_
#undef NACRE_VISIBILITY_INVERSE_LENGTH_INL_H_
#else
#define NACRE_VISIBILITY_INVERSE_LENGTH_INL_H_
#endif

#include "base/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
