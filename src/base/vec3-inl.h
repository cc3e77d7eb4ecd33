// SPDX-License-Identifier: Apache-2.0
// base/vec3-inl.h: 3-D vectors on SIMD vectors, one per lane or one in all of them.
#if defined(NACRE_BASE_VEC3_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BASE_VEC3_INL_H_
#undef NACRE_BASE_VEC3_INL_H_
#else
#define NACRE_BASE_VEC3_INL_H_
#endif

#include "hwy/highway.h"

#include "base/vec.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Vec3V {
  V x, y, z;
};

// v in all lanes, rounded to the lanes' type.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> SetVec3(D d, const Vec3d& v) {
  using T = hn::TFromD<D>;
  return {hn::Set(d, static_cast<T>(v.x)), hn::Set(d, static_cast<T>(v.y)),
          hn::Set(d, static_cast<T>(v.z))};
}

// Products and sums of Dot and Cross are never fused, so that every target gives the same bits. For
// geometry.
template <class V>
HWY_INLINE V Dot(const Vec3V<V>& a, const Vec3V<V>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

template <class V>
HWY_INLINE Vec3V<V> Cross(const Vec3V<V>& a, const Vec3V<V>& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

// Fused if the target has fused multiply-add: faster and more accurate, but with different bits on
// other targets. For shading.
template <class V>
HWY_INLINE V FusedDot(const Vec3V<V>& a, const Vec3V<V>& b) {
  return hn::MulAdd(a.z, b.z, hn::MulAdd(a.y, b.y, hn::Mul(a.x, b.x)));
}

template <class V>
HWY_INLINE Vec3V<V> FusedCross(const Vec3V<V>& a, const Vec3V<V>& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
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
HWY_INLINE Vec3V<V> Negated(const Vec3V<V>& a) {
  return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)};
}

// Component by component.
template <class V>
HWY_INLINE Vec3V<V> Mul3(const Vec3V<V>& a, const Vec3V<V>& b) {
  return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}

template <class V>
HWY_INLINE Vec3V<V> Scale(const Vec3V<V>& a, V s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}

// a b + c, fused if the target can.
template <class V>
HWY_INLINE Vec3V<V> MulAdd3(const Vec3V<V>& a, V b, const Vec3V<V>& c) {
  return {hn::MulAdd(a.x, b, c.x), hn::MulAdd(a.y, b, c.y), hn::MulAdd(a.z, b, c.z)};
}

// a b - c, fused if the target can.
template <class V>
HWY_INLINE Vec3V<V> MulSub3(const Vec3V<V>& a, V b, const Vec3V<V>& c) {
  return {hn::MulSub(a.x, b, c.x), hn::MulSub(a.y, b, c.y), hn::MulSub(a.z, b, c.z)};
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

// Rounded to float.
template <class D, class V = hn::Vec<D>>
HWY_INLINE auto Demote3(D /*d*/, const Vec3V<V>& v) {
  const hn::Rebind<float, D> df;
  return Vec3V<hn::Vec<decltype(df)>>{hn::DemoteTo(df, v.x), hn::DemoteTo(df, v.y),
                                      hn::DemoteTo(df, v.z)};
}

// These take the arrays of x, y and z as `xyz`, and load and store their entries from i on.
template <class D, class Arrays, class Index>
HWY_INLINE Vec3V<hn::Vec<D>> Load3(D d, const Arrays& xyz, Index i) {
  return Load3(d, xyz[0] + i, xyz[1] + i, xyz[2] + i);
}
template <class D, class V, class Arrays, class Index>
HWY_INLINE void Store3(const Vec3V<V>& v, D d, Arrays&& xyz, Index i) {
  Store3(v, d, xyz[0] + i, xyz[1] + i, xyz[2] + i);
}

// Loads from addresses that need not be aligned.
template <class D, class T>
HWY_INLINE Vec3V<hn::Vec<D>> LoadU3(D d, const T* x, const T* y, const T* z) {
  return {hn::LoadU(d, x), hn::LoadU(d, y), hn::LoadU(d, z)};
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
