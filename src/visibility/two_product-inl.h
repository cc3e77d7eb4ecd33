// visibility/two_product-inl.h: products without rounding error, and vectors of three, on SIMD
// vectors. Scalar twin: visibility/two_product.h. The results are exact, so every target gives
// the same bits, with a fused multiply-add or without.
#if defined(NACRE_VISIBILITY_TWO_PRODUCT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_TWO_PRODUCT_INL_H_
#undef NACRE_VISIBILITY_TWO_PRODUCT_INL_H_
#else
#define NACRE_VISIBILITY_TWO_PRODUCT_INL_H_
#endif

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
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
// The upper half of a's digits (Veltkamp 1968): products of two halves are exact.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V UpperHalf(D d, V a) {
  static_assert(sizeof(hn::TFromD<D>) == sizeof(double), "the split is double's");
  const V scaled = hn::Mul(a, hn::Set(d, 0x1p27 + 1));
  return hn::Sub(scaled, hn::Sub(scaled, a));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE TwoProductV<V> TwoProduct(D d, V a, V b) {
  const V product = hn::Mul(a, b);
  const V a1 = UpperHalf(d, a), a2 = hn::Sub(a, a1);
  const V b1 = UpperHalf(d, b), b2 = hn::Sub(b, b1);
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

template <class V>
struct Vec3V {
  V x, y, z;
};

// Multiplies and adds stay apart: a fused one would give other bits on some targets.
template <class V>
HWY_INLINE V Dot(const Vec3V<V>& a, const Vec3V<V>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

template <class V>
HWY_INLINE Vec3V<V> Add(const Vec3V<V>& a, const Vec3V<V>& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}

template <class V>
HWY_INLINE Vec3V<V> Sub(const Vec3V<V>& a, const Vec3V<V>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

template <class V>
HWY_INLINE Vec3V<V> Scale(const Vec3V<V>& a, V s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}

template <class V>
HWY_INLINE V SumOfAbs(const Vec3V<V>& a) {
  return hn::Add(hn::Add(hn::Abs(a.x), hn::Abs(a.y)), hn::Abs(a.z));
}

template <class M, class V>
HWY_INLINE Vec3V<V> Select(M mask, const Vec3V<V>& yes, const Vec3V<V>& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}

template <class D, class T>
HWY_INLINE Vec3V<hn::Vec<D>> Load3(D d, const T* x, const T* y, const T* z) {
  return {hn::Load(d, x), hn::Load(d, y), hn::Load(d, z)};
}

template <class D, class V>
HWY_INLINE void Store3(const Vec3V<V>& v, D d, hn::TFromD<D>* x, hn::TFromD<D>* y,
                       hn::TFromD<D>* z) {
  hn::Store(v.x, d, x);
  hn::Store(v.y, d, y);
  hn::Store(v.z, d, z);
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
