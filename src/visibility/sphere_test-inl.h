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
  V root;
  Vec3V<V> moment;
};

// The line of the ray meets the sphere if this is not negative. dd is |direction|^2, and moment
// to_center x direction.
template <class V>
HWY_INLINE V Discriminant(V radius2, V dd, const Vec3V<V>& moment) {
  return hn::MulSub(radius2, dd, FusedDot(moment, moment));
}

// inverse_dd is 1 / |direction|^2.
template <class D, class V = hn::Vec<D>>
HWY_INLINE SphereHitV<D> TestSphere(D d, const Vec3V<V>& to_center, const Vec3V<V>& direction,
                                    V inverse_dd, V radius) {
  const V zero = hn::Zero(d);
  const V radius2 = hn::Mul(radius, radius);
  const Vec3V<V> moment = AccurateCross(d, to_center, direction);
  const V discriminant = Discriminant(radius2, FusedDot(direction, direction), moment);
  SphereHitV<D> result;
  const V closest = hn::Mul(FusedDot(to_center, direction), inverse_dd);
  result.closest = closest;
  result.root = hn::Sqrt(hn::Max(discriminant, zero));
  result.moment = moment;
  // One comparison decides both, because in the middle of a sphere `closest` may be 0 of either
  // sign.
  const auto ahead = hn::Gt(closest, zero);
  const V half_chord = hn::Mul(result.root, inverse_dd);
  const V larger = hn::Add(closest, hn::IfThenElse(ahead, half_chord, hn::Neg(half_chord)));
  const V product = hn::Mul(hn::Sub(FusedDot(to_center, to_center), radius2), inverse_dd);
  const V smaller = hn::Div(product, larger);
  const V near = hn::IfThenElse(ahead, smaller, larger);
  const V far = hn::IfThenElse(ahead, larger, smaller);
  const auto outside = hn::Gt(near, zero);
  result.inside = hn::Not(outside);
  result.t = hn::IfThenElse(outside, near, far);
  result.hit =
      hn::And(hn::And(hn::Ge(discriminant, zero), hn::Gt(radius, zero)), hn::Gt(result.t, zero));
  return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
