// SPDX-License-Identifier: Apache-2.0
// visibility/occluder_lists_kernel.cc: tests vectors of shadow rays from one sphere against its
// list of possible occluders. Most rays are decided in float, the others in double.
#include "visibility/occluder_lists.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/occluder_lists_kernel.cc"
#include "hwy/foreach_target.h"

#include "base/target_ops-inl.h"
#include "visibility/occlusion-inl.h"
#include "visibility/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using F = hn::ScalableTag<float>;
using VF = hn::Vec<F>;

// A vector of rays that start on one sphere, in float.
struct ListRays {
  Vec3V<VF> to_own;     // from the origin to that sphere's centre
  Vec3V<VF> direction;  // unit
  VF length;            // of the ray, up to t_max
  uint32_t active;      // bits: lanes with t_max > 0
};

HWY_INLINE Vec3V<VF> SubtractAndRound3(const Vec3d& minuend, const Soa3<double>& from,
                                       size_t first) {
  return {SubtractAndRound(F(), minuend.x, from.x.data() + first),
          SubtractAndRound(F(), minuend.y, from.y.data() + first),
          SubtractAndRound(F(), minuend.z, from.z.data() + first)};
}

// Directions whose squares leave the range of float become NaN, and are left to the exact test.
HWY_INLINE ListRays LoadListRays(const ShadowRayBatch& rays, size_t first, const Vec3d& own) {
  const F d;
  ListRays loaded;
  loaded.to_own = SubtractAndRound3(own, rays.origin, first);
  const Vec3V<VF> back = SubtractAndRound3(Vec3d(0, 0, 0), rays.direction, first);
  const VF length2 = FusedDot(back, back);
  const VF scale =
      hn::IfThenElse(hn::And(hn::Gt(length2, hn::Set(d, 1e-30f)), hn::Lt(length2, hn::Inf(d))),
                     ReciprocalSqrt(d, length2), hn::NaN(d));
  loaded.direction = Scale(back, hn::Neg(scale));
  const VF t_max = hn::Neg(SubtractAndRound(d, 0, rays.t_max.data() + first));
  loaded.length = hn::Mul(t_max, hn::Mul(length2, scale));
  loaded.active = BitsOfMask(d, hn::Gt(t_max, hn::Zero(d)));
  return loaded;
}

// The approach of rays to a sphere's centre.
struct Approach {
  VF distance2;  // squared distance of the origin from the centre
  VF along;      // distance along the ray to the point nearest to the centre; negative behind the
                 // origin
};

HWY_INLINE Approach FindApproach(const FloatOccluder& sphere, const ListRays& rays) {
  const F d;
  const Vec3V<VF> to_center{hn::Add(hn::Set(d, sphere.center[0]), rays.to_own.x),
                            hn::Add(hn::Set(d, sphere.center[1]), rays.to_own.y),
                            hn::Add(hn::Set(d, sphere.center[2]), rays.to_own.z)};
  return {FusedDot(to_center, to_center), FusedDot(to_center, rays.direction)};
}

// Because sums, products and the direction are rounded, the squared distance of the line is off by
// less than 32 2^-24 of the squared distance of the centres. Rays that start outside a sphere and
// approach its centre point towards it by far more than that. With a NaN direction both comparisons
// below are false, so that the exact test decides.
constexpr float kSlack = 2e-6f;

// The rays that surely miss the sphere: their nearest point to the centre, which is the origin for
// rays that move away, is outside.
HWY_INLINE hn::Mask<F> SurelyMiss(const FloatOccluder& sphere, const Approach& approach) {
  const F d;
  const VF ahead = hn::Max(approach.along, hn::Zero(d));
  const VF distance2 = hn::Mul(approach.distance2, hn::Set(d, 1 - kSlack));
  return hn::Gt(hn::NegMulAdd(ahead, approach.along, distance2), hn::Set(d, sphere.outer2));
}

// The rays that start outside the sphere and surely hit it before they end.
HWY_INLINE hn::Mask<F> SurelyHit(const FloatOccluder& sphere, const Approach& approach,
                                 const VF& length) {
  const F d;
  const VF along = approach.along;
  const VF along2 = hn::Mul(along, along);
  const VF nearer = hn::Mul(approach.distance2, hn::Set(d, 1 - kSlack));
  const VF farther = hn::Mul(approach.distance2, hn::Set(d, 1 + kSlack));
  const auto outside = hn::Gt(nearer, hn::Set(d, sphere.outer2));
  const auto near = hn::Lt(hn::Sub(farther, along2), hn::Set(d, sphere.inner2));
  const auto ahead = hn::Gt(along, hn::Zero(d));
  const auto before_end = hn::Lt(hn::Mul(along, hn::Set(d, 1 + 1e-5f)), length);
  return hn::And(hn::And(outside, near), hn::And(ahead, before_end));
}

// Collects those spheres in the list of sphere `start` that any of the rays `pending` may hit;
// returns their number. There is no branch, because no branch predictor would find a pattern.
HWY_INLINE size_t FindNear(const OccluderLists& lists, uint32_t start, const ListRays& rays,
                           uint32_t pending, uint32_t* near) {
  size_t count = 0;
  for (uint32_t i = lists.Begin(start); i < lists.end[start]; ++i) {
    const FloatOccluder& occluder = lists.floats[i];
    const uint32_t missed = BitsOfMask(F(), SurelyMiss(occluder, FindApproach(occluder, rays)));
    near[count] = i;
    count += (pending & ~missed) != 0 ? 1 : 0;
  }
  return count;
}

// Returns those of the rays `pending`, as bits, that are occluded. All of them start on sphere
// `start`.
HWY_INLINE uint32_t OccludedByList(const TraceGeometry& geometry, const OccluderLists& lists,
                                   uint32_t start, const ShadowRayBatch& rays, size_t first,
                                   uint32_t pending) {
  const F d;
  const TraceSphere& own = geometry.spheres[start];
  const ListRays floats = LoadListRays(rays, first, own.center);
  pending &= floats.active;
  uint32_t occluded = 0;
  uint32_t near[kMaxListedSpheres];
  const size_t count = FindNear(lists, start, floats, pending, near);
  for (size_t k = 0; k < count && pending != 0; ++k) {
    const FloatOccluder& occluder = lists.floats[near[k]];
    const Approach approach = FindApproach(occluder, floats);
    uint32_t blocked = BitsOfMask(d, SurelyHit(occluder, approach, floats.length)) & pending;
    const uint32_t open = pending & ~(blocked | BitsOfMask(d, SurelyMiss(occluder, approach)));
    if (open != 0) {
      const TraceSphere& sphere = geometry.spheres[lists.spheres[near[k]]];
      blocked |= OccludedBits(D(), sphere, rays, first, open, Coincide(sphere, own) ? open : 0);
    }
    occluded |= blocked;
    pending &= ~blocked;
  }
  return occluded;
}

struct PointBox {
  Vec3d low, high;
};

// The box of the first `count` points.
HWY_INLINE PointBox BoxOf(const Soa3<double>& points, size_t count) {
  const D d;
  const size_t lanes = hn::Lanes(d);
  PointBox box;
  for (int c = 0; c < 3; ++c) {
    const double* const values = ChannelOf(points, c).data();
    V low = hn::Set(d, values[0]), high = low;
    size_t i = 0;
    for (; i + lanes <= count; i += lanes) {
      const V v = hn::Load(d, values + i);
      low = hn::Min(low, v);
      high = hn::Max(high, v);
    }
    box.low[c] = hn::GetLane(hn::MinOfLanes(d, low));
    box.high[c] = hn::GetLane(hn::MaxOfLanes(d, high));
    for (; i < count; ++i) {
      box.low[c] = std::min(box.low[c], values[i]);
      box.high[c] = std::max(box.high[c], values[i]);
    }
  }
  return box;
}

// A ball that contains all positions of the batch.
TraceSphere BoundPositionsT(const HitBatch& hits) {
  const auto [low, high] = BoxOf(hits.position, hits.count);
  return {(low + high) / 2, (high - low).length() / 2 * (1 + 1e-9)};
}

// The rays, as bits, for which the lists do not hold.
HWY_INLINE uint32_t NotListed(const OccluderLists& lists, const ShadowRayBatch& rays, size_t first,
                              size_t count) {
  uint32_t others = 0;
  for (size_t lane = 0; lists.outward_only && lane < count; ++lane) {
    others |= static_cast<uint32_t>(rays.own_after[first + lane] != kLeavesOutward) << lane;
  }
  return others;
}

// Returns those of `lanes`, as bits, whose rays any sphere occludes. All start on sphere `start`.
HWY_INLINE uint32_t OccludedByAny(const TraceGeometry& geometry, uint32_t start,
                                  const ShadowRayBatch& rays, size_t first, uint32_t lanes) {
  uint32_t occluded = 0;
  for (uint32_t i = 0; i < geometry.SphereCount() && lanes != occluded; ++i) {
    if (rays.target.Contains(i)) continue;
    const TraceSphere& sphere = geometry.spheres[i];
    const uint32_t open = lanes & ~occluded;
    occluded |= OccludedBits(D(), sphere, rays, first, open,
                             Coincide(sphere, geometry.spheres[start]) ? open : 0);
  }
  return occluded;
}

// Tests rays [first, end), which all start on one sphere.
HWY_INLINE void OccludedOfRun(const TraceGeometry& geometry, const OccluderLists& lists,
                              size_t first, size_t end, ShadowRayBatch* rays) {
  const size_t step = hn::Lanes(F());
  const uint32_t start = rays->primitive[first];
  for (; first < end; first += step) {
    const size_t count = std::min(step, end - first);
    const uint32_t lanes = (1u << count) - 1;
    const uint32_t others = NotListed(lists, *rays, first, count);
    uint32_t occluded = OccludedByList(geometry, lists, start, *rays, first, lanes & ~others);
    if (others != 0) occluded |= OccludedByAny(geometry, start, *rays, first, others);
    StoreOccluded(occluded, first, count, rays);
  }
}

void OccludedByListsT(const TraceGeometry& geometry, const OccluderLists& lists,
                      ShadowRayBatch* rays) {
  const uint32_t* const start = rays->primitive.data();
  for (size_t first = 0; first < rays->count;) {
    size_t end = first + 1;
    while (end < rays->count && start[end] == start[first]) ++end;
    if (start[first] < lists.end.size()) {
      OccludedOfRun(geometry, lists, first, end, rays);
    } else {  // rays start on the light's own triangles, which are black
      std::fill(rays->occluded.data() + first, rays->occluded.data() + end, uint8_t{0});
    }
    first = end;
  }
}

}  // namespace
}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(BoundPositionsT);
HWY_EXPORT(OccludedByListsT);

bool MayShadow(const TraceGeometry& geometry, const OccluderLists& lists, const ShadowLight& light,
               const HitBatch& hits) {
  const TraceSphere ball = HWY_DYNAMIC_DISPATCH(BoundPositionsT)(hits);
  return MayShadow(geometry, lists, light, hits.primitive[0], ball);
}

void OccludedByLists(const TraceGeometry& geometry, const OccluderLists& lists,
                     ShadowRayBatch* rays) {
  HWY_DYNAMIC_DISPATCH(OccludedByListsT)(geometry, lists, rays);
}
}  // namespace nacre
#endif
