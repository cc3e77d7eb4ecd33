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

// What the ray's whole line does: `hit` is whether it meets the sphere; `inside` and `t` are not
// set. inverse_dd is 1 / |direction|^2.
template <class D, class V = hn::Vec<D>>
HWY_INLINE SphereHitV<D> TestLine(D d, const Vec3V<V>& to_center, const Vec3V<V>& direction,
                                  V inverse_dd, V radius) {
  const V zero = hn::Zero(d);
  SphereHitV<D> result;  // filled member by member: GCC 12 copies nested aggregates through memory
  const V first_closest = hn::Mul(Dot(to_center, direction), inverse_dd);
  const auto along_x = TwoProduct(d, first_closest, direction.x);
  const auto along_y = TwoProduct(d, first_closest, direction.y);
  const auto along_z = TwoProduct(d, first_closest, direction.z);
  const Vec3V<V> rough{hn::Sub(hn::Sub(to_center.x, along_x.product), along_x.error),
                       hn::Sub(hn::Sub(to_center.y, along_y.product), along_y.error),
                       hn::Sub(hn::Sub(to_center.z, along_z.product), along_z.error)};
  const V correction = hn::Mul(Dot(rough, direction), inverse_dd);
  result.perpendicular.x = hn::Sub(rough.x, hn::Mul(direction.x, correction));
  result.perpendicular.y = hn::Sub(rough.y, hn::Mul(direction.y, correction));
  result.perpendicular.z = hn::Sub(rough.z, hn::Mul(direction.z, correction));
  result.closest = hn::Add(first_closest, correction);
  const V discriminant =
      hn::Sub(hn::Mul(radius, radius), Dot(result.perpendicular, result.perpendicular));
  result.hit = hn::And(hn::Ge(discriminant, zero), hn::Gt(radius, zero));
  result.half_chord = hn::Sqrt(hn::Mul(hn::Max(discriminant, zero), inverse_dd));
  return result;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE SphereHitV<D> TestSphere(D d, const Vec3V<V>& to_center, const Vec3V<V>& direction,
                                    V inverse_dd, V radius) {
  const V zero = hn::Zero(d);
  SphereHitV<D> result = TestLine(d, to_center, direction, inverse_dd, radius);
  const V closest = result.closest;
  // Both by the same sign: closest may be 0 with either, in the middle of a sphere.
  const auto ahead = hn::Gt(closest, zero);
  const V half_chord = result.half_chord;
  const V larger = hn::Add(closest, hn::IfThenElse(ahead, half_chord, hn::Neg(half_chord)));
  const V product =
      hn::Mul(hn::Sub(Dot(to_center, to_center), hn::Mul(radius, radius)), inverse_dd);
  const V smaller = hn::Div(product, larger);
  const V near = hn::IfThenElse(ahead, smaller, larger);
  const V far = hn::IfThenElse(ahead, larger, smaller);
  const auto outside = hn::Gt(near, zero);
  result.inside = hn::Not(outside);
  result.t = hn::IfThenElse(outside, near, far);
  result.hit = hn::And(result.hit, hn::Gt(result.t, zero));
  return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
