// SPDX-License-Identifier: Apache-2.0
// visibility/sphere_test-inl.h: the ray-sphere test on SIMD vectors. Scalar twin, with the
// derivation: visibility/sphere_test.h.
#if defined(NACRE_VISIBILITY_SPHERE_TEST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_SPHERE_TEST_INL_H_
#undef NACRE_VISIBILITY_SPHERE_TEST_INL_H_
#else
#define NACRE_VISIBILITY_SPHERE_TEST_INL_H_
#endif

#include "visibility/two_product-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D, class V = hn::Vec<D>>
struct SphereHitV {
  hn::Mask<D> hit;
  hn::Mask<D> inside;
  V t;
  V closest;
  V half_chord;
  Vec3V<V> perpendicular;
};

// What the ray's whole line does: it meets the sphere if `discriminant`, the squared half chord's
// length, is not below 0.
template <class D, class V = hn::Vec<D>>
struct LineV {
  V closest;
  V discriminant;
  Vec3V<V> perpendicular;
};

// inverse_dd is 1 / |direction|^2.
template <class D, class V = hn::Vec<D>>
HWY_INLINE LineV<D> TestLine(D d, const Vec3V<V>& to_center, const Vec3V<V>& direction,
                             V inverse_dd, V radius) {
  LineV<D> result;  // filled member by member: GCC 12 copies nested aggregates through memory
  const V first_closest = hn::Mul(FusedDot(to_center, direction), inverse_dd);
  const Vec3V<V> rough{SubtractProduct(d, to_center.x, first_closest, direction.x),
                       SubtractProduct(d, to_center.y, first_closest, direction.y),
                       SubtractProduct(d, to_center.z, first_closest, direction.z)};
  const V correction = hn::Mul(FusedDot(rough, direction), inverse_dd);
  result.perpendicular.x = hn::NegMulAdd(direction.x, correction, rough.x);
  result.perpendicular.y = hn::NegMulAdd(direction.y, correction, rough.y);
  result.perpendicular.z = hn::NegMulAdd(direction.z, correction, rough.z);
  result.closest = hn::Add(first_closest, correction);
  result.discriminant =
      hn::Sub(hn::Mul(radius, radius), FusedDot(result.perpendicular, result.perpendicular));
  return result;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE SphereHitV<D> TestSphere(D d, const Vec3V<V>& to_center, const Vec3V<V>& direction,
                                    V inverse_dd, V radius) {
  const V zero = hn::Zero(d);
  const LineV<D> line = TestLine(d, to_center, direction, inverse_dd, radius);
  SphereHitV<D> result;
  result.closest = line.closest;
  result.half_chord = hn::Sqrt(hn::Mul(hn::Max(line.discriminant, zero), inverse_dd));
  result.perpendicular = line.perpendicular;
  const V closest = result.closest;
  // Both by the same sign: closest may be 0 with either, in the middle of a sphere.
  const auto ahead = hn::Gt(closest, zero);
  const V half_chord = result.half_chord;
  const V larger = hn::Add(closest, hn::IfThenElse(ahead, half_chord, hn::Neg(half_chord)));
  const V product =
      hn::Mul(hn::Sub(FusedDot(to_center, to_center), hn::Mul(radius, radius)), inverse_dd);
  const V smaller = hn::Div(product, larger);
  const V near = hn::IfThenElse(ahead, smaller, larger);
  const V far = hn::IfThenElse(ahead, larger, smaller);
  const auto outside = hn::Gt(near, zero);
  result.inside = hn::Not(outside);
  result.t = hn::IfThenElse(outside, near, far);
  result.hit = hn::And(hn::And(hn::Ge(line.discriminant, zero), hn::Gt(radius, zero)),
                       hn::Gt(result.t, zero));
  return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
