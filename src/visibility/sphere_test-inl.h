// SPDX-License-Identifier: Apache-2.0
// visibility/sphere_test-inl.h: the ray-sphere test on SIMD vectors, and the point and the normal
// of a hit, with the same bits for every tracing method. Scalar twin, with the derivation:
// visibility/sphere_test.h.
#if defined(NACRE_VISIBILITY_SPHERE_TEST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_SPHERE_TEST_INL_H_
#undef NACRE_VISIBILITY_SPHERE_TEST_INL_H_
#else
#define NACRE_VISIBILITY_SPHERE_TEST_INL_H_
#endif

#include "visibility/sphere_test.h"
#include "visibility/two_product-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
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

// The radius with the sign of -root, where `root` is negative for rays that start outside the
// sphere. It is negative for rays that start inside: their normals point inward.
template <class V>
HWY_INLINE V SignedRadius(V radius, V root) {
  return hn::CopySign(radius, hn::Neg(root));
}

// The vector from a sphere's centre to the hit, times |direction|^2, without forming the point on
// the ray, whose rounding grows with its distance. Scalar twin: ScaledCenterToHit. `root` is
// negative where the ray starts outside. If the direction is reversed, so that moment and root
// change their signs, the bits of the result stay the same, but for the signs of zeros.
template <class V>
HWY_INLINE Vec3V<V> ScaledCenterToHit(const Vec3V<V>& direction, V root, const Vec3V<V>& moment) {
  return MulAdd3(direction, root, FusedCross(moment, direction));
}

// The unit normal on the ray's side, from the vector of ScaledCenterToHit and dd = |direction|^2.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> SphereNormal(D d, const Vec3V<V>& to_hit, V dd, V signed_radius) {
  return Scale(to_hit, hn::Div(hn::Set(d, 1.0), hn::Mul(dd, signed_radius)));
}

template <class V>
HWY_INLINE Vec3V<V> SpherePosition(const Vec3V<V>& center, const Vec3V<V>& normal,
                                   V signed_radius) {
  return MulAdd3(normal, signed_radius, center);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
