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

// 1 / radius of a sphere; negative where `along`, half the chord that is negative where the ray
// starts outside, is not: normals then point inward.
template <class V>
HWY_INLINE V TurnedInverse(V inverse_radius, V along) {
  return hn::CopySign(inverse_radius, hn::Neg(along));
}

// Of a sphere's hit. The hit is centre + radius x normal: the point on the ray, whose rounding
// grows with its distance, is never formed.
template <class D, class V = hn::Vec<D>>
HWY_INLINE SurfaceV<D> SphereSurface(D /*d*/, const Vec3V<V>& direction, V along,
                                     const Vec3V<V>& perpendicular, const Vec3V<V>& center,
                                     V turned_inverse) {
  const Vec3V<V> from_center = Sub(Scale(direction, along), perpendicular);
  SurfaceV<D> surface;
  surface.position = Add(center, from_center);
  surface.normal = Scale(from_center, turned_inverse);
  return surface;
}

// 1 / sqrt(v) to at least 14 bits, for v within float's range. AVX-512 has an instruction for that,
// several times faster than the root and the quotient.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V RoughInverseSqrt(D d, V v) {
#if HWY_TARGET <= HWY_AVX3
  (void)d;
  return V{_mm512_maskz_rsqrt14_pd(0xff, v.raw)};  // GCC 12 warns of the plain one
#else
  const hn::Rebind<float, D> df;
  return hn::PromoteTo(d, hn::Div(hn::Set(df, 1.0f), hn::Sqrt(hn::DemoteTo(df, v))));
#endif
}

// Minus the direction, made a unit vector. dd = |direction|^2 of a camera ray: well within float's
// range. Two of Newton's steps take the first guess, good to 14 bits, to double's precision.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3V<V> ToView(D d, const Vec3V<V>& direction, V dd) {
  const V half_dd = hn::Mul(dd, hn::Set(d, 0.5));
  const V three_halves = hn::Set(d, 1.5);
  V root = RoughInverseSqrt(d, dd);
  root = hn::Mul(root, hn::Sub(three_halves, hn::Mul(half_dd, hn::Mul(root, root))));
  root = hn::Mul(root, hn::Sub(three_halves, hn::Mul(half_dd, hn::Mul(root, root))));
  return Scale(direction, hn::Neg(root));
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
