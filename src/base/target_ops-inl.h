// base/target_ops-inl.h: the few operations whose fastest exact form depends on the target. The
// only #if on HWY_TARGET in nacre.
//
// AVX-512 estimates reciprocals to 14 bits: one Newton step makes a float of them, within 1 ulp,
// in a third of a division's time. Elsewhere an estimate has 12 bits and would need two steps,
// which the dividers beat.
#if defined(NACRE_BASE_TARGET_OPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BASE_TARGET_OPS_INL_H_
#undef NACRE_BASE_TARGET_OPS_INL_H_
#else
#define NACRE_BASE_TARGET_OPS_INL_H_
#endif

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
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

// Doubles rounded to float, a whole vector of floats from two of doubles.
HWY_INLINE hn::Vec<hn::ScalableTag<float>> RoundPair(hn::ScalableTag<float> d,
                                                     hn::Vec<hn::ScalableTag<double>> low,
                                                     hn::Vec<hn::ScalableTag<double>> high) {
#if HWY_TARGET == HWY_SCALAR
  (void)high;
  return hn::DemoteTo(d, low);
#else
  const hn::Half<hn::ScalableTag<float>> dh;
  return hn::Combine(d, hn::DemoteTo(dh, high), hn::DemoteTo(dh, low));
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
