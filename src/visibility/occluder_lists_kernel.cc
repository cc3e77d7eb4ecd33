// SPDX-License-Identifier: Apache-2.0
// visibility/occluder_lists_kernel.cc: vectors of shadow rays from one sphere against its list.
// Floats tell of most of them; the rest are decided in double.
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
using F = hn::ScalableTag<float>;
using VF = hn::Vec<F>;

// Rays are asked for a vector of floats at a time.
constexpr size_t kMaxBlock = kVectorBytes / sizeof(float);

// The rays of a block that start on one sphere, in float, from its centre.
struct FloatRays {
  Vec3V<VF> origin, direction;
  VF inverse_dd, t_max;
};

HWY_INLINE VF LoadFloats(const double* from, double less) {
  const D d;
  const hn::Rebind<float, D> half;
  alignas(kVectorBytes) float floats[kMaxBlock];
  for (size_t i = 0; i < hn::Lanes(F()); i += hn::Lanes(d)) {
    const V v = hn::Sub(hn::LoadU(d, from + i), hn::Set(d, less));
    hn::StoreU(hn::DemoteTo(half, v), half, floats + i);
  }
  return hn::Load(F(), floats);
}

HWY_INLINE FloatRays LoadFloatRays(const ShadowRayBatch& rays, size_t first, const Vec3d& center) {
  FloatRays loaded;
  loaded.origin = {LoadFloats(rays.origin.x.data() + first, center.x),
                   LoadFloats(rays.origin.y.data() + first, center.y),
                   LoadFloats(rays.origin.z.data() + first, center.z)};
  loaded.direction = {LoadFloats(rays.direction.x.data() + first, 0),
                      LoadFloats(rays.direction.y.data() + first, 0),
                      LoadFloats(rays.direction.z.data() + first, 0)};
  loaded.inverse_dd = hn::Div(hn::Set(F(), 1.0f), Dot(loaded.direction, loaded.direction));
  loaded.t_max = LoadFloats(rays.t_max.data() + first, 0);
  return loaded;
}

struct Verdict {
  hn::Mask<F> met, missed;  // both surely; in neither, doubles must tell
};

// Sums, products and the direction's own rounding make the squared distance from the line err by
// less than 32 2^-24 of that of the centres, and the sine of a ray's slope towards the sphere by
// less than 1e-5. Comparisons are false, and nothing is sure, where anything overflows.
HWY_INLINE Verdict Propose(const OccluderProposal& sphere, const FloatRays& rays) {
  const F d;
  const Vec3V<VF> to_center{hn::Sub(hn::Set(d, sphere.center[0]), rays.origin.x),
                            hn::Sub(hn::Set(d, sphere.center[1]), rays.origin.y),
                            hn::Sub(hn::Set(d, sphere.center[2]), rays.origin.z)};
  const VF along = FusedDot(to_center, rays.direction);
  const VF closest = hn::Mul(along, rays.inverse_dd);
  const VF way2 = hn::Mul(along, closest);
  const VF distance2 = FusedDot(to_center, to_center);
  const VF line2 = hn::Sub(distance2, way2);
  const VF slack = hn::Mul(distance2, hn::Set(d, 2e-6f));
  const VF outer2 = hn::Add(hn::Set(d, sphere.outer2), slack);
  const VF inner2 = hn::Sub(hn::Set(d, sphere.inner2), slack);
  const auto far = hn::Gt(line2, outer2);
  const auto outside = hn::Gt(distance2, outer2);
  const auto steep = hn::Gt(way2, hn::Mul(distance2, hn::Set(d, 1e-10f)));
  const auto ahead = hn::Gt(along, hn::Zero(d));
  const auto clear = hn::And(outside, steep);
  const auto before_end = hn::Lt(hn::Mul(closest, hn::Set(d, 1 + 1e-5f)), rays.t_max);
  const auto near = hn::Lt(line2, inner2);
  return {hn::And(hn::And(clear, ahead), hn::And(near, before_end)),
          hn::Or(far, hn::AndNot(ahead, clear))};
}

// Those of the block's rays `pending`, as bits, that a sphere of the list is in the way of, which
// the exact test decides.
HWY_INLINE uint32_t OccludedExactly(const TraceSphere& sphere, const TraceSphere& own,
                                    const ShadowRayBatch& rays, size_t first, uint32_t pending) {
  const D d;
  const auto none = hn::Lt(hn::Zero(d), hn::Zero(d));
  const auto starting = Coincide(sphere, own) ? hn::Not(none) : none;
  uint32_t occluded = 0;
  for (size_t lane = 0; lane < hn::Lanes(F()); lane += hn::Lanes(d)) {
    const auto lanes = MaskOfBits(d, pending, static_cast<int>(lane));
    if (hn::AllFalse(d, lanes)) continue;
    const ShadowRaysV<D> loaded = LoadShadowRays(d, rays, first + lane);
    const auto blocked = OccludedLanes(d, sphere, loaded, lanes, starting, rays.outward);
    occluded |= BitsOfMask(d, blocked) << lane;
  }
  return occluded;
}

// The spheres of a list that rays are asked about.
struct ListPart {
  const uint32_t* entries;  // numbers of OccluderLists::spheres and proposals
  size_t count;
};

// The rays `pending` of a block, which all start on sphere `start`, that something is in the way
// of.
HWY_INLINE uint32_t OccludedByList(const TraceGeometry& geometry, const OccluderLists& lists,
                                   const ListPart& part, uint32_t start, const ShadowRayBatch& rays,
                                   size_t first, uint32_t pending) {
  const F d;
  const TraceSphere& own = geometry.spheres[start];
  const FloatRays floats = LoadFloatRays(rays, first, own.center);
  pending &= BitsOfMask(d, hn::Gt(floats.t_max, hn::Zero(d)));
  uint32_t occluded = 0;
  for (size_t k = 0; k < part.count && pending != 0; ++k) {
    const uint32_t i = part.entries[k];
    const Verdict verdict = Propose(lists.proposals[i], floats);
    uint32_t blocked = BitsOfMask(d, verdict.met) & pending;
    const uint32_t open = pending & ~(blocked | BitsOfMask(d, verdict.missed));
    if (open != 0) {
      const TraceSphere& sphere = geometry.spheres[lists.spheres[i]];
      blocked |= OccludedExactly(sphere, own, rays, first, open);
    }
    occluded |= blocked;
    pending &= ~blocked;
  }
  return occluded;
}

struct Range {
  double low, high;
};

HWY_INLINE Range RangeOf(const double* values, size_t first, size_t end) {
  const D d;
  const size_t lanes = hn::Lanes(d);
  V low = hn::Set(d, values[first]), high = low;
  size_t i = first;
  for (; i + lanes <= end; i += lanes) {
    const V v = hn::LoadU(d, values + i);
    low = hn::Min(low, v);
    high = hn::Max(high, v);
  }
  Range range{hn::GetLane(hn::MinOfLanes(d, low)), hn::GetLane(hn::MaxOfLanes(d, high))};
  for (; i < end; ++i) {
    range.low = std::min(range.low, values[i]);
    range.high = std::max(range.high, values[i]);
  }
  return range;
}

// Rays that leave outward stay above the plane that touches the sphere where they start, but for
// what their directions' rounding makes of grazing ones (2e-6): spheres below the planes of all
// their origins are left out. Returns the rest of the list of sphere `start`.
HWY_INLINE size_t FindAbove(const TraceGeometry& geometry, const OccluderLists& lists,
                            uint32_t start, const ShadowRayBatch& rays, size_t first, size_t end,
                            uint32_t* entries) {
  const TraceSphere& own = geometry.spheres[start];
  const Range box[3] = {RangeOf(rays.origin.x.data(), first, end),
                        RangeOf(rays.origin.y.data(), first, end),
                        RangeOf(rays.origin.z.data(), first, end)};
  size_t count = 0;
  for (uint32_t i = lists.Begin(start); i < lists.end[start]; ++i) {
    const TraceSphere& sphere = geometry.spheres[lists.spheres[i]];
    const Vec3d offset = sphere.center - own.center;
    double highest = 0;  // of the centre over the planes through the own centre
    for (int c = 0; c < 3; ++c) {
      highest += std::max(offset[c] * (box[c].low - own.center[c]),
                          offset[c] * (box[c].high - own.center[c]));
    }
    const double margin =
        1e-5 * (offset.length() + own.radius + sphere.radius) + 1e-12 * own.center.length();
    const bool below = highest < (own.radius - sphere.radius - margin) * own.radius;
    if (!below || !rays.outward) entries[count++] = i;
  }
  return count;
}

HWY_INLINE void StoreOccluded(uint32_t occluded, size_t first, size_t count, ShadowRayBatch* rays) {
  for (size_t lane = 0; lane < count; ++lane) {
    rays->occluded[first + lane] = static_cast<uint8_t>((occluded >> lane) & 1);
  }
}

// Rays [first, end), all from one sphere.
HWY_INLINE void OccludedOfRun(const TraceGeometry& geometry, const OccluderLists& lists,
                              size_t first, size_t end, ShadowRayBatch* rays) {
  const size_t step = hn::Lanes(F());
  const uint32_t start = rays->primitive[first];
  uint32_t entries[kMaxListedSpheres];
  const size_t kept = FindAbove(geometry, lists, start, *rays, first, end, entries);
  for (; first < end; first += step) {
    const size_t count = std::min(step, end - first);
    const uint32_t lanes = (1u << count) - 1;
    StoreOccluded(OccludedByList(geometry, lists, {entries, kept}, start, *rays, first, lanes),
                  first, count, rays);
  }
}

void OccludedByListsT(const TraceGeometry& geometry, const OccluderLists& lists,
                      ShadowRayBatch* rays) {
  const uint32_t* const start = rays->primitive.data();
  for (size_t first = 0; first < rays->count;) {
    size_t end = first + 1;
    while (end < rays->count && start[end] == start[first]) ++end;
    OccludedOfRun(geometry, lists, first, end, rays);
    first = end;
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
