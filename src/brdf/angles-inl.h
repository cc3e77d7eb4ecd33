// brdf/angles-inl.h: the angles of brdf/angles.h on SIMD vectors.
#if defined(NACRE_BRDF_ANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BRDF_ANGLES_INL_H_
#undef NACRE_BRDF_ANGLES_INL_H_
#else
#define NACRE_BRDF_ANGLES_INL_H_
#endif

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Vec3V {
  V x, y, z;
};

template <class D, class T = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> Load3(D d, const T* x, const T* y, const T* z, size_t i) {
  return {hn::LoadU(d, x + i), hn::LoadU(d, y + i), hn::LoadU(d, z + i)};
}

template <class V>
HWY_INLINE V Dot(const Vec3V<V>& a, const Vec3V<V>& b) {
  return hn::MulAdd(a.z, b.z, hn::MulAdd(a.y, b.y, hn::Mul(a.x, b.x)));
}

template <class V>
HWY_INLINE Vec3V<V> Cross(const Vec3V<V>& a, const Vec3V<V>& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

template <class V>
HWY_INLINE Vec3V<V> Add3(const Vec3V<V>& a, const Vec3V<V>& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}

template <class V>
HWY_INLINE Vec3V<V> Sub3(const Vec3V<V>& a, const Vec3V<V>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

template <class V>
HWY_INLINE Vec3V<V> Scale3(const Vec3V<V>& a, V s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}

template <class V>
struct AnglesV {
  V n_dot_l, n_dot_v, n_dot_u, u_squared, nxu_squared, lv_squared;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE AnglesV<V> ComputeAngles(D d, const Vec3V<V>& n, const Vec3V<V>& l, const Vec3V<V>& v) {
  const Vec3V<V> l_minus_v = Sub3(l, v);
  const Vec3V<V> sum = Add3(l, v);
  const V along = hn::Mul(Dot(sum, l_minus_v), hn::Set(d, hn::TFromD<D>(0.25)));
  const Vec3V<V> u{hn::NegMulAdd(l_minus_v.x, along, sum.x),
                   hn::NegMulAdd(l_minus_v.y, along, sum.y),
                   hn::NegMulAdd(l_minus_v.z, along, sum.z)};
  const Vec3V<V> n_cross_u = Cross(n, u);
  return {Dot(n, l),
          Dot(n, v),
          Dot(n, u),
          Dot(u, u),
          Dot(n_cross_u, n_cross_u),
          Dot(l_minus_v, l_minus_v)};
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
