// SPDX-License-Identifier: Apache-2.0
// visibility/surface-inl.h: the point, the normal and the view direction of a hit, with the same
// bits for every tracing method.
#if defined(NACRE_VISIBILITY_SURFACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_SURFACE_INL_H_
#undef NACRE_VISIBILITY_SURFACE_INL_H_
#else
#define NACRE_VISIBILITY_SURFACE_INL_H_
#endif

#include "base/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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

// The negated direction as a unit vector.
template <class V>
HWY_INLINE Vec3V<V> ToView(const Vec3V<V>& direction, V inverse_length) {
  return Scale(direction, hn::Neg(inverse_length));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE auto Demote3(D /*d*/, const Vec3V<V>& v) {
  const hn::Rebind<float, D> df;
  return Vec3V<hn::Vec<decltype(df)>>{hn::DemoteTo(df, v.x), hn::DemoteTo(df, v.y),
                                      hn::DemoteTo(df, v.z)};
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
