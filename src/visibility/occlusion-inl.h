// SPDX-License-Identifier: Apache-2.0
// visibility/occlusion-inl.h: whether a sphere is in the way of shadow rays, in double: what every
// way of finding candidates asks in the end.
#if defined(NACRE_VISIBILITY_OCCLUSION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_OCCLUSION_INL_H_
#undef NACRE_VISIBILITY_OCCLUSION_INL_H_
#else
#define NACRE_VISIBILITY_OCCLUSION_INL_H_
#endif

#include "base/geometry-inl.h"
#include "hit/batch.h"
#include "visibility/geometry.h"
#include "visibility/packet-inl.h"
#include "visibility/sphere_test-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Rays, one a lane, for which a sphere may be in the way at 0 < t < t_max.
template <class D, class V = hn::Vec<D>>
struct ShadowRaysV {
  Vec3V<V> origin, direction;
  V inverse_dd;  // 1 / |direction|^2
  V t_max;
  double end_reach;  // ShadowRayBatch's
};

// Where the rays end, from their origins. Infinite or NaN of those that do not end.
template <class D>
HWY_INLINE Vec3V<hn::Vec<D>> ToEnd(const ShadowRaysV<D>& rays) {
  return Scale(rays.direction, rays.t_max);
}

// An upper bound of the coordinates that the ends of rays were computed from.
template <class D>
HWY_INLINE hn::Vec<D> EndReach(D d, const ShadowRaysV<D>& rays) {
  return hn::Add(hn::Add(SumOfAbs(rays.origin), SumOfAbs(ToEnd(rays))), hn::Set(d, rays.end_reach));
}

// The lanes whose end cannot be told from a point of the sphere: the light lies on this surface.
//
// Let u = 2^-53 and R the sum of the origin's, the end's and the sphere's coordinates and radius,
// of |to_center| and of the camera's coordinates. The light and the sphere are off by u R each as
// they are given and by as much again relative to the camera; a rectangle's corner by another 4 u R
// and the end on an area light, from its plane's equation, by 10 u R (FindEnds of
// shading/sampled_light.h); direction, to_center and their difference by 4 u R: altogether at most
// 22 u R. What that makes of |from_end|^2 - r^2 is as much times |from_end| + r, and its own
// rounding 5 u of that times R.
//
// `load` loads the rays once more: few are asked, and rays kept for them would take the registers
// of all.
template <class D, class LoadRays, class V = hn::Vec<D>>
HWY_NOINLINE hn::Mask<D> EndsOnSphere(D d, const LoadRays& load, const TraceSphere& sphere) {
  constexpr double kUnit = 0x1p-53;
  const ShadowRaysV<D> rays = load();
  const V radius = hn::Set(d, sphere.radius);
  const Vec3V<V> to_center = Sub(SetVec3(d, sphere.center), rays.origin);
  const Vec3V<V> from_end = Sub(to_center, ToEnd(rays));
  const V reach = hn::Add(hn::Add(EndReach(d, rays), radius), SumOfAbs(to_center));
  const V off = hn::Abs(hn::Sub(Dot(from_end, from_end), hn::Mul(radius, radius)));
  const V bound =
      hn::Mul(hn::Mul(hn::Set(d, 32 * kUnit), reach), hn::Add(SumOfAbs(from_end), radius));
  return hn::And(hn::Lt(rays.t_max, hn::Inf(d)), hn::Le(off, bound));
}

// From the sphere itself, or one that coincides with it, one root is 0, and the other twice the
// way to the closest approach: negative for a ray that leaves outward, whatever the rounding of
// its origin. `own`: the lanes that start there; with `outward` it is never in their way. To a
// light on the sphere one root is t_max, whatever the rounding, and the other as far before the
// closest approach as that is behind it: only this one, if any, is in the way.
template <class D, class LoadRays, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> InTheWay(D d, const TraceSphere& sphere, const SphereHitV<D>& hit,
                                hn::Mask<D> own, bool outward, V t_max, const LoadRays& load) {
  const auto zero = hn::Zero(d);
  const auto t = hn::IfThenElse(own, hn::Add(hit.closest, hit.closest), hit.t);
  const auto met_own = outward ? hn::Lt(zero, zero) : hn::And(own, hn::Gt(t, zero));
  const auto met = hn::And(hn::Or(met_own, hn::AndNot(own, hit.hit)), hn::Lt(t, t_max));
  // Few are asked: those that meet the sphere in the ray's second half, and nowhere else before its
  // end.
  const auto late = hn::And(met, hn::Gt(hn::Add(t, t), t_max));
  if (hn::AllFalse(d, late)) return met;
  const V other = hn::Sub(hn::Add(hit.closest, hit.closest), t_max);
  const auto before_end = hn::AndNot(own, hn::And(hn::Gt(other, zero), hn::Lt(other, t_max)));
  const auto unsure = hn::AndNot(before_end, late);
  if (hn::AllFalse(d, unsure)) return met;
  return hn::AndNot(hn::And(unsure, EndsOnSphere(d, load, sphere)), met);
}

// The rays from any number on.
template <class D>
HWY_INLINE ShadowRaysV<D> LoadShadowRays(D d, const ShadowRayBatch& rays, size_t i) {
  ShadowRaysV<D> loaded;
  loaded.origin =
      LoadU3(d, rays.origin.x.data() + i, rays.origin.y.data() + i, rays.origin.z.data() + i);
  loaded.direction = LoadU3(d, rays.direction.x.data() + i, rays.direction.y.data() + i,
                            rays.direction.z.data() + i);
  loaded.inverse_dd = hn::Div(hn::Set(d, 1.0), FusedDot(loaded.direction, loaded.direction));
  loaded.t_max = hn::LoadU(d, rays.t_max.data() + i);
  loaded.end_reach = rays.end_reach;
  return loaded;
}

// The rays of a packet.
template <class D>
HWY_INLINE ShadowRaysV<D> ShadowRaysOf(D d, const Packet& packet, int lane) {
  return {Origin(d, packet, lane), Direction(d, packet, lane),
          hn::Load(d, packet.inverse_dd + lane), hn::Load(d, packet.t_max + lane),
          packet.end_reach};
}

// Most spheres are missed by all lanes, and by far. Before any root is taken, the distance of the
// ray's line from the centre tells, or that the ray starts outside and leaves. Either errs by a few
// 2^-53 of the centre's distance.
template <class D, class V = hn::Vec<D>>
HWY_INLINE bool SurelyMissed(D d, const Vec3V<V>& to_center, const ShadowRaysV<D>& rays,
                             hn::Mask<D> lanes, V radius) {
  const V along = Dot(to_center, rays.direction);
  const V closest = hn::Mul(along, rays.inverse_dd);
  const Vec3V<V> perpendicular = Sub(to_center, Scale(rays.direction, closest));
  const V distance2 = Dot(to_center, to_center);
  const V slack = hn::Mul(hn::Set(d, 1e-12), distance2);
  const V reach2 = hn::MulAdd(hn::Mul(radius, radius), hn::Set(d, 1 + 1e-9), slack);
  const auto near_line = hn::Le(Dot(perpendicular, perpendicular), reach2);
  const auto leaves = hn::And(hn::Lt(along, hn::Zero(d)), hn::Gt(hn::Mul(along, closest), slack));
  const auto gone = hn::And(leaves, hn::Gt(distance2, reach2));
  return hn::AllFalse(d, hn::And(lanes, hn::AndNot(gone, near_line)));
}

// Those of `lanes` that the sphere is in the way of. `own`: the lanes that start on it. `load`
// loads `rays`.
template <class D, class LoadRays>
HWY_INLINE hn::Mask<D> OccludedLanes(D d, const TraceSphere& sphere, const ShadowRaysV<D>& rays,
                                     hn::Mask<D> lanes, hn::Mask<D> own, bool outward,
                                     const LoadRays& load) {
  using V = hn::Vec<D>;
  const Vec3V<V> center{hn::Set(d, sphere.center.x), hn::Set(d, sphere.center.y),
                        hn::Set(d, sphere.center.z)};
  const Vec3V<V> to_center = Sub(center, rays.origin);
  const V radius = hn::Set(d, sphere.radius);
  // Rays that start on the sphere may be further from it than that, by the rounding of a distant
  // origin.
  const bool leaves_it = !outward && !hn::AllFalse(d, own);
  if (!leaves_it && SurelyMissed(d, to_center, rays, lanes, radius)) return hn::Lt(radius, radius);
  const auto hit = TestSphere(d, to_center, rays.direction, rays.inverse_dd, radius);
  return hn::And(lanes, InTheWay(d, sphere, hit, own, outward, rays.t_max, load));
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
