// SPDX-License-Identifier: Apache-2.0
// base/geometry-inl.h: SIMD vectors that hold one Vec3d in all lanes, and cross products that have
// the same bits on every target.
#if defined(NACRE_BASE_GEOMETRY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BASE_GEOMETRY_INL_H_
#undef NACRE_BASE_GEOMETRY_INL_H_
#else
#define NACRE_BASE_GEOMETRY_INL_H_
#endif

#include "base/vec.h"
#include "base/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// v in all lanes, rounded to the lanes' type.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> SetVec3(D d, const Vec3d& v) {
  using T = hn::TFromD<D>;
  return {hn::Set(d, static_cast<T>(v.x)), hn::Set(d, static_cast<T>(v.y)),
          hn::Set(d, static_cast<T>(v.z))};
}

// Products and sums are never fused, as in Dot.
template <class V>
HWY_INLINE Vec3V<V> Cross(const Vec3V<V>& a, const Vec3V<V>& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
