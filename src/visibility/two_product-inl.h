// SPDX-License-Identifier: Apache-2.0
// visibility/two_product-inl.h: products without rounding error on SIMD vectors. Scalar twin:
// visibility/two_product.h. Exact results have the same bits on every target, with fused
// multiply-add or without.
#if defined(NACRE_VISIBILITY_TWO_PRODUCT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_TWO_PRODUCT_INL_H_
#undef NACRE_VISIBILITY_TWO_PRODUCT_INL_H_
#else
#define NACRE_VISIBILITY_TWO_PRODUCT_INL_H_
#endif

#include "base/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct TwoProductV {
  V product;
  V error;
};

#if HWY_NATIVE_FMA
template <class D, class V = hn::Vec<D>>
HWY_INLINE TwoProductV<V> TwoProduct(D /*d*/, V a, V b) {
  const V product = hn::Mul(a, b);
  return {product, hn::MulSub(a, b, product)};
}
#else
// The upper half of a's digits (Veltkamp 1968): products of two halves are exact. (Not called
// UpperHalf, because for vectors of one lane Highway's function of that name would be called.)
template <class D, class V = hn::Vec<D>>
HWY_INLINE V UpperDigits(D d, V a) {
  static_assert(sizeof(hn::TFromD<D>) == sizeof(double), "the split is double's");
  const V scaled = hn::Mul(a, hn::Set(d, 0x1p27 + 1));
  return hn::Sub(scaled, hn::Sub(scaled, a));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE TwoProductV<V> TwoProduct(D d, V a, V b) {
  const V product = hn::Mul(a, b);
  const V a1 = UpperDigits(d, a), a2 = hn::Sub(a, a1);
  const V b1 = UpperDigits(d, b), b2 = hn::Sub(b, b1);
  const V upper = hn::Sub(hn::Mul(a1, b1), product);
  const V middle = hn::Add(hn::Add(upper, hn::Mul(a1, b2)), hn::Mul(a2, b1));
  return {product, hn::Add(middle, hn::Mul(a2, b2))};
}
#endif

template <class D, class V = hn::Vec<D>>
HWY_INLINE V DifferenceOfProducts(D d, V a, V b, V c, V e) {
  const auto ab = TwoProduct(d, a, b);
  const auto ce = TwoProduct(d, c, e);
  return hn::Add(hn::Sub(ab.product, ce.product), hn::Sub(ab.error, ce.error));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V AccurateDifference(D d, V a, V b, V c, V e) {
#if HWY_NATIVE_FMA
  (void)d;
  const V product = hn::Mul(c, e);
  return hn::Add(hn::MulSub(a, b, product), hn::NegMulAdd(c, e, product));
#else
  return DifferenceOfProducts(d, a, b, c, e);
#endif
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> AccurateCross(D d, const Vec3V<V>& a, const Vec3V<V>& b) {
  return {AccurateDifference(d, a.y, b.z, a.z, b.y), AccurateDifference(d, a.z, b.x, a.x, b.z),
          AccurateDifference(d, a.x, b.y, a.y, b.x)};
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
