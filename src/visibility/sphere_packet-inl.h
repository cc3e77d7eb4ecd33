// SPDX-License-Identifier: Apache-2.0
// visibility/sphere_packet-inl.h: tests a packet against one sphere, in double.
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

template <class D, class V = hn::Vec<D>>
HWY_INLINE SphereHitV<D> TestLanes(D d, const Packet& packet, int lane, const TraceSphere& sphere) {
  return TestSphere(d, Sub(SetVec3(d, sphere.center), Origin(d, packet, lane)),
                    Direction(d, packet, lane), hn::Load(d, packet.inverse_dd + lane),
                    hn::Set(d, sphere.radius));
}

// Records hits of the general test for rays that leave surfaces. For rays that start on this sphere
// one root is 0, however their origin is rounded, and the other is twice the distance to the
// closest approach, or 0 for a ray that leaves inward along the sphere.
template <class D>
HWY_INLINE void RecordFromSurfaces(D d, const TraceSphere& sphere, uint32_t primitive,
                                   const SphereHitV<D>& hit, hn::Mask<D> asked, int lane,
                                   Packet* packet) {
  const auto is_start = StartsOn(d, packet->start_spheres, lane, sphere);
  const auto far = hn::Add(hit.closest, hit.closest);
  const auto met_own = hn::And(is_start, hn::Gt(far, hn::Load(d, packet->own_after + lane)));
  const auto met = hn::Or(met_own, hn::AndNot(is_start, hit.hit));
  const auto far_side = hn::Max(far, hn::Zero(d));
  RecordClosest(d, packet, lane, hn::And(asked, met), hn::IfThenElse(is_start, far_side, hit.t),
                primitive);
}

// Tests `lanes`, as bits, and records hits that are nearer than the nearest so far.
HWY_INLINE void IntersectLanes(const TraceSphere& sphere, uint32_t primitive, uint32_t lanes,
                               Packet* packet) {
  const hn::ScalableTag<double> d;
  const int step = static_cast<int>(hn::Lanes(d));
  const bool projected = UsesProjectedTest(sphere, packet->view);
  const ProjectedSphere projection =
      projected ? MakeProjectedSphere(sphere, packet->view.forward) : ProjectedSphere{};
  for (int lane = 0; lane < packet->width; lane += step) {
    const auto asked = MaskOfBits(d, lanes, lane);
    if (hn::AllFalse(d, asked)) continue;
    if (projected) {
      const auto hit = TestProjectedDepth(d, projection, sphere, Direction(d, *packet, lane));
      RecordClosest(d, packet, lane, hn::And(asked, hit.hit), hit.t, primitive);
    } else {
      const auto hit = TestLanes(d, *packet, lane, sphere);
      if (packet->from_surfaces) {
        RecordFromSurfaces(d, sphere, primitive, hit, asked, lane, packet);
      } else {
        RecordClosest(d, packet, lane, hn::And(asked, hit.hit), hit.t, primitive);
      }
    }
  }
}

// Marks those of `lanes`, as bits, that the sphere occludes.
HWY_INLINE void OccludeLanes(const TraceSphere& sphere, uint32_t lanes, Packet* packet) {
  const hn::ScalableTag<double> d;
  const int step = static_cast<int>(hn::Lanes(d));
  uint32_t occluded = 0;
  for (int lane = 0; lane < packet->width; lane += step) {
    const auto asked = MaskOfBits(d, lanes, lane);
    if (hn::AllFalse(d, asked)) continue;
    const auto load = [&]() HWY_ATTR { return ShadowRaysOf(d, *packet, lane); };
    const auto own = StartsOn(d, packet->start_spheres, lane, sphere);
    const auto in_the_way =
        InTheWay(d, sphere, TestLanes(d, *packet, lane, sphere), own,
                 hn::Load(d, packet->own_after + lane), hn::Load(d, packet->t_max + lane), load);
    occluded |= BitsOfMask(d, hn::And(asked, in_the_way)) << lane;
  }
  RecordOccluded(packet, occluded);
}

}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
