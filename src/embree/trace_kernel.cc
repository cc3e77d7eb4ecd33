// SPDX-License-Identifier: Apache-2.0
// embree/trace_kernel.cc: passes packets of rays to Embree.
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

void Nearer(const TraceScene& scene, const RayBatch& rays, ClosestHits* hits) {
  EmbreePacket to(scene.packet_width, scene.scene, scene.geometry);
  for (size_t first = 0; first < rays.count; first += to.Width()) {
    FillClosest(rays, first, hits, &to.packet);
    FillOrigins(scene.offset, &to);
    ChooseLanes(&to);
    IntersectPacket(to.packet.width, to.valid, to.scene, &to.context, &to.rays);
  }
}

void Occluded(const TraceScene& scene, ShadowRayBatch* rays) {
  EmbreePacket to(scene.packet_width, scene.scene, scene.geometry);
  for (size_t first = 0; first < rays->count; first += to.Width()) {
    FillShadowPacket(*rays, first, &to.packet);
    FillOrigins(scene.offset, &to);
    ChooseLanes(&to);
    OccludedPacket(to.packet.width, to.valid, to.scene, &to.context, &to.rays);
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
