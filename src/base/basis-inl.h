// SPDX-License-Identifier: Apache-2.0
// base/basis-inl.h: orthonormal bases, directions around an axis and points of the unit disk on
// SIMD vectors. Scalar twin: base/basis.h.
#if defined(NACRE_BASE_BASIS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_BASE_BASIS_INL_H_
#undef NACRE_BASE_BASIS_INL_H_
#else
#define NACRE_BASE_BASIS_INL_H_
#endif

#include "base/basis.h"
#include "base/trig-inl.h"
#include "base/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct BasisV {
  Vec3V<V> x, y, z;
};

// Duff et al. 2017.
template <class D, class V = hn::Vec<D>>
HWY_INLINE BasisV<V> BasisAbout(D d, const Vec3V<V>& z) {
  const V one = hn::Set(d, hn::TFromD<D>(1));
  const V sign = hn::IfThenElse(hn::Lt(z.z, hn::Zero(d)), hn::Neg(one), one);
  const V a = hn::Neg(hn::Div(one, hn::Add(sign, z.z)));
  const V b = hn::Mul(hn::Mul(z.x, z.y), a);
  const V signed_x = hn::Mul(sign, z.x);
  return {{hn::MulAdd(hn::Mul(signed_x, z.x), a, one), hn::Mul(sign, b), hn::Neg(signed_x)},
          {b, hn::MulAdd(hn::Mul(z.y, z.y), a, sign), hn::Neg(z.y)},
          z};
}

template <class V>
HWY_INLINE Vec3V<V> ToWorld(const BasisV<V>& basis, const Vec3V<V>& local) {
  const auto mix = [&](V x, V y, V z) {
    return hn::MulAdd(z, local.z, hn::MulAdd(y, local.y, hn::Mul(x, local.x)));
  };
  return {mix(basis.x.x, basis.y.x, basis.z.x), mix(basis.x.y, basis.y.y, basis.z.y),
          mix(basis.x.z, basis.y.z, basis.z.z)};
}

template <class V>
HWY_INLINE Vec3V<V> ToLocal(const BasisV<V>& basis, const Vec3V<V>& world) {
  return {FusedDot(basis.x, world), FusedDot(basis.y, world), FusedDot(basis.z, world)};
}

// The direction at 1 - cos = x from `axis`, with azimuth 2 pi u1.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> DirectionAround(D d, const Vec3V<V>& axis, V x, V u1) {
  const V one = hn::Set(d, 1.0f);
  const V sin = hn::Sqrt(hn::Mul(x, hn::Sub(hn::Set(d, 2.0f), x)));
  const SinCosV<V> phi = SinCosTurns(d, u1);
  return ToWorld(BasisAbout(d, axis),
                 Vec3V<V>{hn::Mul(sin, phi.cos), hn::Mul(sin, phi.sin), hn::Sub(one, x)});
}

// Shirley and Chiu 1997: angles are at most an eighth of a turn, plus a quarter.
template <class D, class V = hn::Vec<D>>
HWY_INLINE PointOnDisk<V> ConcentricDisk(D d, V u0, V u1) {
  const V zero = hn::Zero(d);
  const V one = hn::Set(d, 1.0f);
  const V two = hn::Set(d, 2.0f);
  const V a = hn::MulSub(two, u0, one), b = hn::MulSub(two, u1, one);
  const auto flat = hn::Gt(hn::Abs(a), hn::Abs(b));
  const V larger = hn::IfThenElse(flat, a, b), smaller = hn::IfThenElse(flat, b, a);
  const V ratio = hn::Div(smaller, hn::IfThenElse(hn::Eq(larger, zero), one, larger));
  const SinCosV<V> phi = SinCosTurns(d, hn::Mul(ratio, hn::Set(d, 0.125f)));
  return {hn::Mul(larger, hn::IfThenElse(flat, phi.cos, phi.sin)),
          hn::Mul(larger, hn::IfThenElse(flat, phi.sin, phi.cos)), hn::Abs(larger)};
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
