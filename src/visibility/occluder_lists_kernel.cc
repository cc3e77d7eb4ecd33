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

// The lanes of `pending`, which all start on sphere `start`, that something is in the way of.
HWY_INLINE hn::Mask<D> OccludedByList(const TraceGeometry& geometry, const OccluderLists& lists,
                                      uint32_t start, const ShadowRaysV<D>& rays,
                                      hn::Mask<D> pending, bool outward) {
  const D d;
  const TraceSphere& own = geometry.spheres[start];
  const auto none = hn::Lt(hn::Zero(d), hn::Zero(d));
  auto occluded = none;
  for (uint32_t i = lists.Begin(start); i < lists.end[start]; ++i) {
    const TraceSphere& sphere = geometry.spheres[lists.spheres[i]];
    const auto starting = Coincide(sphere, own) ? hn::Not(none) : none;
    const auto blocked = OccludedLanes(d, sphere, rays, pending, starting, outward);
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
    const ShadowRaysV<D> loaded = LoadShadowRays(d, *rays, first);
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
          BitsOfMask(d, OccludedByList(geometry, lists, sphere, loaded, lanes, rays->outward));
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
