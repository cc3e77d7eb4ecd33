// visibility/occluder_lists_kernel.cc: vectors of shadow rays from one sphere against its list.
#include "visibility/occluder_lists.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/occluder_lists_kernel.cc"
#include "hwy/foreach_target.h"

#include "visibility/occlusion-inl.h"
#include "visibility/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;

HWY_INLINE ShadowRaysV<D> LoadRays(const ShadowRayBatch& rays, size_t i) {
  const D d;
  ShadowRaysV<D> loaded;
  loaded.origin =
      Load3(d, rays.origin.x.data() + i, rays.origin.y.data() + i, rays.origin.z.data() + i);
  loaded.direction = Load3(d, rays.direction.x.data() + i, rays.direction.y.data() + i,
                           rays.direction.z.data() + i);
  loaded.inverse_dd = hn::Div(hn::Set(d, 1.0), Dot(loaded.direction, loaded.direction));
  loaded.t_max = hn::Load(d, rays.t_max.data() + i);
  return loaded;
}

// Most candidates are missed by all lanes, and by far: the distance of the ray's line from the
// centre tells, before any root is taken. It errs by a few 2^-53 of the centre's distance.
HWY_INLINE bool SurelyMissed(D d, const Vec3V<V>& to_center, const ShadowRaysV<D>& rays,
                             hn::Mask<D> lanes, V radius) {
  const V closest = hn::Mul(Dot(to_center, rays.direction), rays.inverse_dd);
  const Vec3V<V> perpendicular = Sub(to_center, Scale(rays.direction, closest));
  const V slack = hn::Mul(hn::Set(d, 1e-12), Dot(to_center, to_center));
  const V reach2 = hn::MulAdd(hn::Mul(radius, radius), hn::Set(d, 1 + 1e-9), slack);
  return hn::AllFalse(d, hn::And(lanes, hn::Le(Dot(perpendicular, perpendicular), reach2)));
}

// The lanes of `pending`, which all start on sphere `start`, that something is in the way of.
HWY_INLINE hn::Mask<D> OccludedLanes(const TraceGeometry& geometry, const OccluderLists& lists,
                                     uint32_t start, const ShadowRaysV<D>& rays,
                                     hn::Mask<D> pending, bool outward) {
  const D d;
  const TraceSphere& own = geometry.spheres[start];
  const auto none = hn::Lt(hn::Zero(d), hn::Zero(d));
  auto occluded = none;
  for (uint32_t i = lists.Begin(start); i < lists.end[start]; ++i) {
    const TraceSphere& sphere = geometry.spheres[lists.spheres[i]];
    const Vec3V<V> center{hn::Set(d, sphere.center.x), hn::Set(d, sphere.center.y),
                          hn::Set(d, sphere.center.z)};
    const Vec3V<V> to_center = Sub(center, rays.origin);
    const V radius = hn::Set(d, sphere.radius);
    if (SurelyMissed(d, to_center, rays, pending, radius)) continue;
    const auto hit = TestSphere(d, to_center, rays.direction, rays.inverse_dd, radius);
    const bool coincides = sphere.center == own.center && sphere.radius == own.radius;
    const auto blocked =
        hn::And(pending, InTheWay(d, hit, coincides ? hn::Not(none) : none, outward, rays.t_max));
    occluded = hn::Or(occluded, blocked);
    pending = hn::AndNot(blocked, pending);
    if (hn::AllFalse(d, pending)) break;
  }
  return occluded;
}

void OccludedByListsT(const TraceGeometry& geometry, const OccluderLists& lists,
                      ShadowRayBatch* rays) {
  const D d;
  const size_t step = hn::Lanes(d);
  for (size_t first = 0; first < rays->count; first += step) {
    const size_t count = std::min(step, rays->count - first);
    const uint32_t* const start = rays->primitive.data() + first;
    const ShadowRaysV<D> loaded = LoadRays(*rays, first);
    uint32_t occluded = 0;
    // Sphere by sphere of those that the vector's rays start on: one, as a rule.
    for (uint32_t left = (1u << count) - 1; left != 0;) {
      const uint32_t sphere = start[__builtin_ctz(left)];
      uint32_t same = 0;
      for (size_t lane = 0; lane < count; ++lane) {
        same |= static_cast<uint32_t>(start[lane] == sphere) << lane;
      }
      left &= ~same;
      const auto lanes = MaskOfBits(d, same, 0);
      occluded |=
          BitsOfMask(d, OccludedLanes(geometry, lists, sphere, loaded, lanes, rays->outward));
    }
    for (size_t lane = 0; lane < count; ++lane) {
      rays->occluded[first + lane] = static_cast<uint8_t>((occluded >> lane) & 1);
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(OccludedByListsT);

void OccludedByLists(const TraceGeometry& geometry, const OccluderLists& lists,
                     ShadowRayBatch* rays) {
  HWY_DYNAMIC_DISPATCH(OccludedByListsT)(geometry, lists, rays);
}
}  // namespace nacre
#endif
