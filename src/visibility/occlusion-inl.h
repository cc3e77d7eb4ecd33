// SPDX-License-Identifier: Apache-2.0
// visibility/occlusion-inl.h: the exact test, in double, of whether a sphere occludes shadow rays.
// It decides the candidates of light bins, occluder lists and Embree alike.
#if defined(NACRE_VISIBILITY_OCCLUSION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_OCCLUSION_INL_H_
#undef NACRE_VISIBILITY_OCCLUSION_INL_H_
#else
#define NACRE_VISIBILITY_OCCLUSION_INL_H_
#endif

#include "base/vec3-inl.h"
#include "hit/batch.h"
#include "visibility/geometry.h"
#include "visibility/packet-inl.h"
#include "visibility/sphere_test-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Shadow rays, one a lane, which are occluded by hits at 0 < t < t_max.
template <class D, class V = hn::Vec<D>>
struct ShadowRaysV {
  Vec3V<V> origin, direction;
  V inverse_dd;  // 1 / |direction|^2
  V t_max, own_after;
  double camera_extent;  // ShadowRayBatch's
};

// The vectors from the rays' origins to their ends. Infinite or NaN for rays that do not end.
template <class D>
HWY_INLINE Vec3V<hn::Vec<D>> ToEnd(const ShadowRaysV<D>& rays) {
  return Scale(rays.direction, rays.t_max);
}

// An upper bound of the coordinates that the ends of the rays were computed from.
template <class D>
HWY_INLINE hn::Vec<D> EndExtent(D d, const ShadowRaysV<D>& rays) {
  return hn::Add(hn::Add(SumOfAbs(rays.origin), SumOfAbs(ToEnd(rays))),
                 hn::Set(d, rays.camera_extent));
}

// The lanes whose end lies on the sphere within the rounding error: the light is on this surface,
// which does not occlude it.
//
// Let u = 2^-53 and R the sum of the origin's, the end's and the sphere's coordinates and radius,
// of |to_center| and of the camera's coordinates. The light and the sphere are each off by u R as
// they are given, and by u R again relative to the camera; a rectangle's corner is off by another 4
// u R, and the end on an area light, from its plane's equation, by 10 u R (FindEnds of
// shading/light_sampling.h); direction, to_center and their difference by 4 u R: altogether by at
// most 22 u R. The resulting error of |from_end|^2 - r^2 is 22 u R (|from_end| + r), and its own
// rounding 5 u R (|from_end| + r).
//
// `load` loads the rays again: this function is rarely called, and keeping the rays for it would
// occupy registers in all its callers.
template <class D, class LoadRays, class V = hn::Vec<D>>
HWY_NOINLINE hn::Mask<D> EndsOnSphere(D d, const LoadRays& load, const TraceSphere& sphere) {
  constexpr double kUnit = 0x1p-53;
  const ShadowRaysV<D> rays = load();
  const V radius = hn::Set(d, sphere.radius);
  const Vec3V<V> to_center = Sub(SetVec3(d, sphere.center), rays.origin);
  const Vec3V<V> from_end = Sub(to_center, ToEnd(rays));
  const V extent = hn::Add(hn::Add(EndExtent(d, rays), radius), SumOfAbs(to_center));
  const V off = hn::Abs(hn::Sub(Dot(from_end, from_end), hn::Mul(radius, radius)));
  const V bound =
      hn::Mul(hn::Mul(hn::Set(d, 32 * kUnit), extent), hn::Add(SumOfAbs(from_end), radius));
  return hn::And(hn::Lt(rays.t_max, hn::Inf(d)), hn::Le(off, bound));
}

// The lanes whose ray the sphere occludes. `own` are the lanes that start on this sphere, or on one
// that coincides with it. For these one root is 0, and the other is twice the distance to the
// closest approach: negative for a ray that leaves outward, however its origin is rounded, and to
// be above the ray's `own_after`; it counts as 0 where rounding has made it negative. If the light
// lies on the sphere, one root is t_max, however it is rounded, and the other lies as far before
// the closest approach as t_max lies behind it: only this other hit can occlude.
template <class D, class LoadRays, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> InTheWay(D d, const TraceSphere& sphere, const SphereHitV<D>& hit,
                                hn::Mask<D> own, V own_after, V t_max, const LoadRays& load) {
  const auto zero = hn::Zero(d);
  const auto own_t = hn::Add(hit.closest, hit.closest);
  const auto t = hn::IfThenElse(own, hn::Max(own_t, zero), hit.t);
  const auto met_own = hn::And(own, hn::Gt(own_t, own_after));
  const auto met = hn::And(hn::Or(met_own, hn::AndNot(own, hit.hit)), hn::Lt(t, t_max));
  // The light may lie on the sphere only if the hit is in the second half of the ray and no other
  // hit comes before its end. This is rare.
  const auto late = hn::And(met, hn::Gt(hn::Add(t, t), t_max));
  if (hn::AllFalse(d, late)) return met;
  const V other = hn::Sub(hn::Add(hit.closest, hit.closest), t_max);
  const auto before_end = hn::AndNot(own, hn::And(hn::Gt(other, zero), hn::Lt(other, t_max)));
  const auto unsure = hn::AndNot(before_end, late);
  if (hn::AllFalse(d, unsure)) return met;
  return hn::AndNot(hn::And(unsure, EndsOnSphere(d, load, sphere)), met);
}

// The lanes whose ray starts on this sphere, or on one that coincides with it.
template <class D>
HWY_INLINE hn::Mask<D> StartsOn(D d, const StartSpheres& starts, int lane,
                                const TraceSphere& sphere) {
  const auto same = [&](const double* values, double value)
                        HWY_ATTR { return hn::Eq(hn::Load(d, values + lane), hn::Set(d, value)); };
  return hn::And(
      hn::And(same(starts.center[0], sphere.center.x), same(starts.center[1], sphere.center.y)),
      hn::And(same(starts.center[2], sphere.center.z), same(starts.radius, sphere.radius)));
}

// Loads a vector of the batch's rays, from any index i on.
template <class D>
HWY_INLINE ShadowRaysV<D> LoadShadowRays(D d, const ShadowRayBatch& rays, size_t i) {
  ShadowRaysV<D> loaded;
  loaded.origin =
      LoadU3(d, rays.origin.x.data() + i, rays.origin.y.data() + i, rays.origin.z.data() + i);
  loaded.direction = LoadU3(d, rays.direction.x.data() + i, rays.direction.y.data() + i,
                            rays.direction.z.data() + i);
  loaded.inverse_dd = hn::Div(hn::Set(d, 1.0), FusedDot(loaded.direction, loaded.direction));
  loaded.t_max = hn::LoadU(d, rays.t_max.data() + i);
  loaded.own_after = hn::LoadU(d, rays.own_after.data() + i);
  loaded.camera_extent = rays.camera_extent;
  return loaded;
}

// Loads a vector of the packet's rays.
template <class D>
HWY_INLINE ShadowRaysV<D> ShadowRaysOf(D d, const Packet& packet, int lane) {
  return {Origin(d, packet, lane),
          Direction(d, packet, lane),
          hn::Load(d, packet.inverse_dd + lane),
          hn::Load(d, packet.t_max + lane),
          hn::Load(d, packet.own_after + lane),
          packet.camera_extent};
}

// The subset of `lanes` whose rays the sphere occludes. `own` are the lanes that start on it.
// `load` loads `rays` again.
template <class D, class LoadRays>
HWY_INLINE hn::Mask<D> OccludedLanes(D d, const TraceSphere& sphere, const ShadowRaysV<D>& rays,
                                     hn::Mask<D> lanes, hn::Mask<D> own, const LoadRays& load) {
  const auto to_center = Sub(SetVec3(d, sphere.center), rays.origin);
  const auto hit =
      TestSphere(d, to_center, rays.direction, rays.inverse_dd, hn::Set(d, sphere.radius));
  return hn::And(lanes, InTheWay(d, sphere, hit, own, rays.own_after, rays.t_max, load));
}

// The subset of `lanes`, as bits, whose rays the sphere occludes, of the batch's rays from `first`
// on. `own` are the lanes that start on it.
template <class D>
HWY_INLINE uint32_t OccludedBits(D d, const TraceSphere& sphere, const ShadowRayBatch& rays,
                                 size_t first, uint32_t lanes, uint32_t own) {
  uint32_t occluded = 0;
  for (int lane = 0; lanes >> lane != 0; lane += static_cast<int>(hn::Lanes(d))) {
    const auto asked = MaskOfBits(d, lanes, lane);
    if (hn::AllFalse(d, asked)) continue;
    const auto load = [&]() HWY_ATTR {
      return LoadShadowRays(d, rays, first + static_cast<size_t>(lane));
    };
    const auto blocked = OccludedLanes(d, sphere, load(), asked, MaskOfBits(d, own, lane), load);
    occluded |= BitsOfMask(d, blocked) << lane;
  }
  return occluded;
}

// Stores the results of the rays [first, first + count); lane 0 is ray `first`.
HWY_INLINE void StoreOccluded(uint32_t occluded, size_t first, size_t count, ShadowRayBatch* rays) {
  for (size_t lane = 0; lane < count; ++lane) {
    rays->occluded[first + lane] = static_cast<uint8_t>((occluded >> lane) & 1);
  }
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
