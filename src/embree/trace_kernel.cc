// SPDX-License-Identifier: Apache-2.0
// embree/trace_kernel.cc: passes packets of rays to Embree, or the rays of a packet one by one.
#include "embree/trace_kernel.h"

#include "embree/embree_packet.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "embree/trace_kernel.cc"
#include "hwy/foreach_target.h"

#include "base/vec3-inl.h"
#include "visibility/fill_packet-inl.h"
#include "visibility/occlusion-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE void ChooseLanes(EmbreePacket* to) {
  for (int lane = 0; lane < to->packet.width; ++lane) {
    to->valid[lane] = (to->packet.lanes >> lane & 1) != 0 ? -1 : 0;
  }
}

// Fills in the origins relative to the BVH's origin.
HWY_INLINE void FillOrigins(const Vec3d& offset, EmbreePacket* to) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<float, decltype(d)> df;
  RTCRayN* const rays = to->ray_n();
  const unsigned width = to->Width();
  for (unsigned lane = 0; lane < width; lane += static_cast<unsigned>(hn::Lanes(d))) {
    const auto origin = Add(Origin(d, to->packet, static_cast<int>(lane)), SetVec3(d, offset));
    hn::StoreU(hn::DemoteTo(df, origin.x), df, &RTCRayN_org_x(rays, width, lane));
    hn::StoreU(hn::DemoteTo(df, origin.y), df, &RTCRayN_org_y(rays, width, lane));
    hn::StoreU(hn::DemoteTo(df, origin.z), df, &RTCRayN_org_z(rays, width, lane));
  }
}

// Whether the packet's directions differ so much that its rays share few boxes of a large BVH: a
// packet visits every box that any of its rays meets, so such rays are faster one by one. The
// largest component of each direction is in [1, 2] (FillLanes); the ranges of the three components
// are added up. The sum is some hundredths for 16 neighbouring camera rays, and 8 to 10 for random
// directions. The answer affects only the time.
HWY_INLINE bool AreIncoherent(const Packet& packet) {
  constexpr float kLimit = 0.5f;
  const hn::CappedTag<float, kMaxPacketWidth> d;
  float extent = 0;
  for (const float* component : packet.floats.direction) {
    auto lowest = hn::Set(d, 2.0f), highest = hn::Set(d, -2.0f);
    for (int lane = 0; lane < packet.width; lane += static_cast<int>(hn::Lanes(d))) {
      const auto asked = MaskOfBits(d, packet.lanes, lane);
      const auto value = hn::LoadU(d, component + lane);
      lowest = hn::Min(lowest, hn::IfThenElse(asked, value, lowest));
      highest = hn::Max(highest, hn::IfThenElse(asked, value, highest));
    }
    extent += hn::GetLane(hn::MaxOfLanes(d, highest)) - hn::GetLane(hn::MinOfLanes(d, lowest));
  }
  return extent > kLimit;
}

// Calls trace(&ray) for each of the packet's rays. Its callbacks find the lane by the ray's id.
template <class Trace>
HWY_INLINE void TraceOneByOne(EmbreePacket* packet, const Trace& trace) {
  const unsigned width = packet->Width();
  RTCRayN* const rays = packet->ray_n();
  for (uint32_t lanes = packet->packet.lanes; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<unsigned>(__builtin_ctz(lanes));
    RTCRayHit one;
    one.ray = rtcGetRayFromRayN(rays, width, lane);
    one.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    trace(&one);
  }
}

void Nearer(const TraceScene& scene, const RayBatch& rays, ClosestHits* hits) {
  EmbreePacket to(scene.packet_width, scene.scene, scene.geometry);
  for (size_t first = 0; first < rays.count; first += to.Width()) {
    FillClosest(rays, first, hits, &to.packet);
    FillOrigins(scene.offset, &to);
    if (scene.is_large && AreIncoherent(to.packet)) {
      TraceOneByOne(&to, [&](RTCRayHit* one) { IntersectOne(to.scene, &to.context, one); });
      continue;
    }
    ChooseLanes(&to);
    IntersectPacket(to.packet.width, to.valid, to.scene, &to.context, &to.rays);
  }
}

void Occluded(const TraceScene& scene, ShadowRayBatch* rays) {
  EmbreePacket to(scene.packet_width, scene.scene, scene.geometry);
  for (size_t first = 0; first < rays->count; first += to.Width()) {
    FillShadowPacket(*rays, first, &to.packet);
    FillOrigins(scene.offset, &to);
    if (scene.is_large && AreIncoherent(to.packet)) {
      TraceOneByOne(&to, [&](RTCRayHit* one) { OccludedOne(to.scene, &to.context, &one->ray); });
    } else {
      ChooseLanes(&to);
      OccludedPacket(to.packet.width, to.valid, to.scene, &to.context, &to.rays);
    }
    StoreOccluded(to.packet.occluded, first, to.Width(), rays);
  }
}

}  // namespace
}  // namespace nacre::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(Nearer);
HWY_EXPORT(Occluded);

void TraceNearer(const TraceScene& scene, const RayBatch& rays, ClosestHits* hits) {
  HWY_DYNAMIC_DISPATCH(Nearer)(scene, rays, hits);
}

void TraceOccluded(const TraceScene& scene, ShadowRayBatch* rays) {
  HWY_DYNAMIC_DISPATCH(Occluded)(scene, rays);
}
}  // namespace nacre
#endif
