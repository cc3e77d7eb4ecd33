// SPDX-License-Identifier: Apache-2.0
// visibility/occlusion-inl.h: whether a sphere is in the way of shadow rays, in double: what every
// way of finding candidates asks in the end.
#if defined(NACRE_VISIBILITY_OCCLUSION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_OCCLUSION_INL_H_
#undef NACRE_VISIBILITY_OCCLUSION_INL_H_
#else
#define NACRE_VISIBILITY_OCCLUSION_INL_H_
#endif

#include "hit/batch.h"
#include "visibility/geometry.h"
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
};

// From the sphere itself, or one that coincides with it, one root is 0, and the other twice the
// way to the closest approach: negative for a ray that leaves outward, whatever the rounding of
// its origin. `own`: the lanes that start there; with `outward` it is never in their way.
template <class D>
HWY_INLINE hn::Mask<D> InTheWay(D d, const SphereHitV<D>& hit, hn::Mask<D> own, bool outward,
                                hn::Vec<D> t_max) {
  const auto zero = hn::Zero(d);
  const auto t = hn::IfThenElse(own, hn::Add(hit.closest, hit.closest), hit.t);
  const auto met_own = outward ? hn::Lt(zero, zero) : hn::And(own, hn::Gt(t, zero));
  const auto met = hn::Or(met_own, hn::AndNot(own, hit.hit));
  return hn::And(met, hn::Lt(t, t_max));
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
  return loaded;
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

// Those of `lanes` that the sphere is in the way of. `own`: the lanes that start on it.
template <class D>
HWY_INLINE hn::Mask<D> OccludedLanes(D d, const TraceSphere& sphere, const ShadowRaysV<D>& rays,
                                     hn::Mask<D> lanes, hn::Mask<D> own, bool outward) {
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
  return hn::And(lanes, InTheWay(d, hit, own, outward, rays.t_max));
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();
#endif
