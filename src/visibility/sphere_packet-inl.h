// SPDX-License-Identifier: Apache-2.0
// visibility/sphere_packet-inl.h: tests a packet against one sphere: a conservative float test
// proposes lanes, and the exact test in double decides.
#if defined(NACRE_VISIBILITY_SPHERE_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NACRE_VISIBILITY_SPHERE_PACKET_INL_H_
#undef NACRE_VISIBILITY_SPHERE_PACKET_INL_H_
#else
#define NACRE_VISIBILITY_SPHERE_PACKET_INL_H_
#endif

#include "base/vec3-inl.h"
#include "visibility/occlusion-inl.h"
#include "visibility/packet-inl.h"
#include "visibility/projected_sphere_test-inl.h"
#include "visibility/sphere_test-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The lanes, as bits, whose float rays come within `error` of the sphere at a depth between 0 and
// their limit. They include all lanes that truly hit it.
//
// Let u = 2^-24 and S = |c|_1 + |o|_1 + r, which bounds every length below. Rounding the centre,
// the origin and their difference moves to_center by at most 2 u (|c| + |o|); the direction is
// off by u, the point of closest approach by another 12 u S along the ray, and the products that
// cancel in `perpendicular` by u S each: altogether |perpendicular| is off by at most 18 u S.
// With error = 32 u S the slack, 28 u S r in the discriminant, covers its own rounding of
// 22 u (r + error)^2. The depths need the same error once for the closest approach and, for the
// rounding of the sum, 3 u S: twice `error` is enough. The direction's length is at least 1
// (FillPacket), so depths err no more than lengths do.
template <class D>
HWY_INLINE uint32_t ProposedOfPacket(D d, const Packet& packet, const TraceSphere& sphere) {
  using V = hn::Vec<D>;
  const Vec3V<V> center = SetVec3(d, sphere.center);
  const V radius = hn::Set(d, static_cast<float>(sphere.radius));
  const V sphere_error =
      hn::Mul(hn::Add(SumOfAbs(center), radius), hn::Set(d, static_cast<float>(32 * kFloatUnit)));
  const FloatRays& rays = packet.floats;
  uint32_t lanes = 0;
  for (int i = 0; i < packet.width; i += static_cast<int>(hn::Lanes(d))) {
    const Vec3V<V> origin = Load3(d, rays.origin, i);
    const Vec3V<V> direction = Load3(d, rays.direction, i);
    const V error = hn::Add(sphere_error, hn::Load(d, packet.origin_error + i));
    const Vec3V<V> to_center = Sub(center, origin);
    const V closest = hn::Mul(Dot(to_center, direction), hn::Load(d, packet.ray_inverse_dd + i));
    const Vec3V<V> perpendicular = Sub(to_center, Scale(direction, closest));
    const V bound = hn::Add(radius, error);
    const V discriminant = hn::Sub(hn::Mul(bound, bound), Dot(perpendicular, perpendicular));
    const V half_chord = hn::Mul(hn::Sqrt(hn::Max(discriminant, hn::Zero(d))),
                                 hn::Load(d, packet.ray_inverse_length + i));
    const V margin = hn::Add(half_chord, hn::Add(error, error));
    const auto near_enough = hn::Le(hn::Sub(closest, margin), hn::Load(d, rays.depth + i));
    const auto ahead = hn::Gt(hn::Add(closest, margin), hn::Zero(d));
    const auto proposed = hn::And(hn::Ge(discriminant, hn::Zero(d)), hn::And(near_enough, ahead));
    lanes |= BitsOfMask(d, proposed) << i;
  }
  return lanes;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE SphereHitV<D> TestLanes(D d, const Packet& packet, int lane, const TraceSphere& sphere) {
  return TestSphere(d, Sub(SetVec3(d, sphere.center), Origin(d, packet, lane)),
                    Direction(d, packet, lane), hn::Load(d, packet.inverse_dd + lane),
                    hn::Set(d, sphere.radius));
}

// Records hits of the general test for rays that leave surfaces. For rays that start on this sphere
// one root is 0, however their origin is rounded, and the other is twice the distance to the
// closest approach.
template <class D>
HWY_INLINE void RecordFromSurfaces(D d, const TraceSphere& sphere, uint32_t primitive,
                                   const SphereHitV<D>& hit, hn::Mask<D> proposed, int lane,
                                   Packet* packet) {
  const auto is_start = StartsOn(d, packet->start_spheres, lane, sphere);
  const auto far = hn::Add(hit.closest, hit.closest);
  const auto met =
      hn::Or(hn::And(is_start, hn::Gt(far, hn::Zero(d))), hn::AndNot(is_start, hit.hit));
  RecordClosest(d, packet, lane, hn::And(proposed, met), hn::IfThenElse(is_start, far, hit.t),
                primitive);
}

// Tests `lanes`, as bits, and records hits that are nearer than the nearest so far.
HWY_INLINE void IntersectLanes(const TraceSphere& sphere, uint32_t primitive, uint32_t lanes,
                               Packet* packet) {
  lanes &= ProposedOfPacket(hn::CappedTag<float, kMaxPacketWidth>(), *packet, sphere);
  if (lanes == 0) return;
  const hn::ScalableTag<double> d;
  const int step = static_cast<int>(hn::Lanes(d));
  const bool projected = UsesProjectedTest(sphere, packet->view);
  const ProjectedSphere projection =
      projected ? MakeProjectedSphere(sphere, packet->view.forward) : ProjectedSphere{};
  for (int lane = 0; lane < packet->width; lane += step) {
    const auto proposed = MaskOfBits(d, lanes, lane);
    if (hn::AllFalse(d, proposed)) continue;
    if (projected) {
      const auto hit = TestProjectedDepth(d, projection, sphere, Direction(d, *packet, lane));
      RecordClosest(d, packet, lane, hn::And(proposed, hit.hit), hit.t, primitive);
    } else {
      const auto hit = TestLanes(d, *packet, lane, sphere);
      if (packet->from_surfaces) {
        RecordFromSurfaces(d, sphere, primitive, hit, proposed, lane, packet);
      } else {
        RecordClosest(d, packet, lane, hn::And(proposed, hit.hit), hit.t, primitive);
      }
    }
  }
}

// Marks those of `lanes`, as bits, that the sphere occludes.
HWY_INLINE void OccludeLanes(const TraceSphere& sphere, uint32_t lanes, Packet* packet) {
  lanes &= ProposedOfPacket(hn::CappedTag<float, kMaxPacketWidth>(), *packet, sphere);
  if (lanes == 0) return;
  const hn::ScalableTag<double> d;
  const int step = static_cast<int>(hn::Lanes(d));
  uint32_t occluded = 0;
  for (int lane = 0; lane < packet->width; lane += step) {
    const auto proposed = MaskOfBits(d, lanes, lane);
    if (hn::AllFalse(d, proposed)) continue;
    const auto load = [&]() HWY_ATTR { return ShadowRaysOf(d, *packet, lane); };
    const auto own = StartsOn(d, packet->start_spheres, lane, sphere);
    const auto in_the_way = InTheWay(d, sphere, TestLanes(d, *packet, lane, sphere), own,
                                     packet->outward, hn::Load(d, packet->t_max + lane), load);
    occluded |= BitsOfMask(d, hn::And(proposed, in_the_way)) << lane;
  }
  RecordOccluded(packet, occluded);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
