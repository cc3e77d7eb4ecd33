// SPDX-License-Identifier: Apache-2.0
// visibility/sphere_test-inl.h: the ray-sphere test on SIMD vectors. Scalar twin, with the
// derivation: visibility/sphere_test.h.
#if defined(NACRE_VISIBILITY_SPHERE_TEST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_SPHERE_TEST_INL_H_
#undef NACRE_VISIBILITY_SPHERE_TEST_INL_H_
#else
#define NACRE_VISIBILITY_SPHERE_TEST_INL_H_
#endif

#include "visibility/sphere_test.h"
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

// IsFarSphere of lanes.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> FarSpheres(D d, V to_center_squared, V radius) {
  const V limit = hn::Mul(hn::Set(d, kNearRadii * kNearRadii), hn::Mul(radius, radius));
  return hn::Gt(to_center_squared, limit);
}

template <class V>
struct ClosestV {
  V closest;
  Vec3V<V> perpendicular;
};

// Of near spheres. inverse_dd is 1 / |direction|^2.
template <class D, class V = hn::Vec<D>>
HWY_INLINE ClosestV<V> ClosestToCenter(D d, const Vec3V<V>& to_center, const Vec3V<V>& direction,
                                       V inverse_dd) {
  const V closest = hn::Mul(FusedDot(to_center, direction), inverse_dd);
  return {closest,
          {SubtractProduct(d, to_center.x, closest, direction.x),
           SubtractProduct(d, to_center.y, closest, direction.y),
           SubtractProduct(d, to_center.z, closest, direction.z)}};
}

// Of far ones, by the same; a correction of 0 leaves its bits.
template <class V>
HWY_INLINE ClosestV<V> AddCorrection(const ClosestV<V>& first, const Vec3V<V>& direction,
                                     V correction) {
  const Vec3V<V>& p = first.perpendicular;
  return {hn::Add(first.closest, correction),
          {hn::NegMulAdd(direction.x, correction, p.x), hn::NegMulAdd(direction.y, correction, p.y),
           hn::NegMulAdd(direction.z, correction, p.z)}};
}

template <class V>
HWY_INLINE ClosestV<V> CorrectClosest(const ClosestV<V>& first, const Vec3V<V>& direction,
                                      V inverse_dd) {
  return AddCorrection(first, direction,
                       hn::Mul(FusedDot(first.perpendicular, direction), inverse_dd));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE LineV<D> MeetSphere(const ClosestV<V>& at, V radius) {
  const Vec3V<V>& p = at.perpendicular;
  return {at.closest, hn::Sub(hn::Mul(radius, radius), FusedDot(p, p)), p};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE SphereHitV<D> TestSphere(D d, const Vec3V<V>& to_center, const Vec3V<V>& direction,
                                    V inverse_dd, V radius) {
  const V zero = hn::Zero(d);
  const V to_center_squared = FusedDot(to_center, to_center);
  const auto first = ClosestToCenter(d, to_center, direction, inverse_dd);
  const V correction =
      hn::IfThenElseZero(FarSpheres(d, to_center_squared, radius),
                         hn::Mul(FusedDot(first.perpendicular, direction), inverse_dd));
  const LineV<D> line = MeetSphere<D>(AddCorrection(first, direction, correction), radius);
  SphereHitV<D> result;
  result.closest = line.closest;
  result.half_chord = hn::Sqrt(hn::Mul(hn::Max(line.discriminant, zero), inverse_dd));
  result.perpendicular = line.perpendicular;
  const V closest = result.closest;
  // Both by the same sign: closest may be 0 with either, in the middle of a sphere.
  const auto ahead = hn::Gt(closest, zero);
  const V half_chord = result.half_chord;
  const V larger = hn::Add(closest, hn::IfThenElse(ahead, half_chord, hn::Neg(half_chord)));
  const V product = hn::Mul(hn::Sub(to_center_squared, hn::Mul(radius, radius)), inverse_dd);
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
