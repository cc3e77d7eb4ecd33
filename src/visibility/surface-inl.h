// SPDX-License-Identifier: Apache-2.0
// visibility/surface-inl.h: the point, the normal and the view direction of a hit, the same bits
// whichever way it was found.
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

template <class D, class V = hn::Vec<D>>
struct SurfaceV {
  Vec3V<V> position;
  Vec3V<V> normal;  // unit, on the ray's side
};

// 1 / radius of a sphere; negative where `half_chord`, negative where the ray starts outside, is
// not: normals then point inward.
template <class V>
HWY_INLINE V TurnedInverse(V inverse_radius, V half_chord) {
  return hn::CopySign(inverse_radius, hn::Neg(half_chord));
}

// Of a sphere's hit. The hit is centre + radius x normal: the point on the ray, whose rounding
// grows with its distance, is never formed; scalar twin: CenterToHit. `half_chord` is negative
// where the ray starts outside; inverse_dd is 1 / |direction|^2.
template <class D, class V = hn::Vec<D>>
HWY_INLINE SurfaceV<D> SphereSurface(D /*d*/, const Vec3V<V>& direction, V inverse_dd, V half_chord,
                                     const Vec3V<V>& perpendicular, const Vec3V<V>& center,
                                     V turned_inverse) {
  const V along = hn::MulAdd(FusedDot(perpendicular, direction), inverse_dd, half_chord);
  const Vec3V<V> from_center{hn::MulSub(direction.x, along, perpendicular.x),
                             hn::MulSub(direction.y, along, perpendicular.y),
                             hn::MulSub(direction.z, along, perpendicular.z)};
  SurfaceV<D> surface;
  surface.position = Add(center, from_center);
  surface.normal = Scale(from_center, turned_inverse);
  return surface;
}

// Minus the direction, made a unit vector.
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
