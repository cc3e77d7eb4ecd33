// SPDX-License-Identifier: Apache-2.0
// visibility/trace_kernel.cc: rounds packets of rays to float for Embree and starts its queries.
#include "visibility/trace_kernel.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/trace_kernel.cc"
#include "hwy/foreach_target.h"

#include "visibility/fill_packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {

// What stays the same for all packets of a batch.
HWY_INLINE void InitPacket(const TraceScene& scene, Packet* packet) {
  InitContext(&packet->context);
  packet->width = scene.packet_width;
  packet->scene = scene.scene;
  packet->geometry = scene.geometry;
  const unsigned width = packet->Width();
  RTCRayN* rays = packet->ray_n();
  auto* hits = RTCRayHitN_HitN(reinterpret_cast<RTCRayHitN*>(&packet->rays), width);
  for (unsigned i = 0; i < width; ++i) {
    RTCRayN_tnear(rays, width, i) = 0;
    RTCRayN_time(rays, width, i) = 0;
    RTCRayN_mask(rays, width, i) = ~0u;
    RTCRayN_id(rays, width, i) = i;
    RTCRayN_flags(rays, width, i) = 0;
    RTCHitN_geomID(hits, width, i) = RTC_INVALID_GEOMETRY_ID;
    RTCHitN_instID(hits, width, i, 0) = RTC_INVALID_GEOMETRY_ID;
  }
}

void Nearer(const TraceScene& scene, const RayBatch& rays, ClosestHits* hits) {
  Packet packet;
  InitPacket(scene, &packet);
  packet.view = rays.view;
  const size_t width = packet.Width();
  for (size_t first = 0; first < rays.count; first += width) {
    packet.best_t = hits->t.data() + first;
    packet.best_primitive = hits->primitive.data() + first;
    packet.t_max = packet.best_t;
    std::fill_n(packet.best_primitive, width, kNoPrimitive);
    FillPacket(rays, first, &packet);
    IntersectPacket(packet.width, packet.valid, packet.scene, &packet.context, &packet.rays);
  }
}

// Bounds the coordinates that a point on the primitive was computed from.
HWY_INLINE double Reach(const TraceGeometry& geometry, uint32_t primitive) {
  const auto sum_of_abs = [](const Vec3d& v) {
    return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
  };
  if (primitive == kNoPrimitive) return 0;
  if (primitive < geometry.SphereCount()) {
    const TraceSphere& sphere = geometry.spheres[primitive];
    return sum_of_abs(sphere.center) + sphere.radius;
  }
  double reach = 0;
  for (const uint32_t vertex : geometry.triangles[primitive - geometry.SphereCount()]) {
    reach = std::max(reach, sum_of_abs(geometry.positions[vertex]));
  }
  return reach;
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

HWY_INLINE void FillStarts(const ShadowRayBatch& rays, size_t first, Packet* packet) {
  const TraceGeometry& geometry = *packet->geometry;
  for (int lane = 0; lane < packet->width; ++lane) {
    const bool holds_ray = packet->valid[lane] != 0;
    const uint32_t start =
        holds_ray ? rays.primitive[first + static_cast<size_t>(lane)] : kNoPrimitive;
    packet->start[lane] = start;
    const bool on_sphere = start < geometry.SphereCount();
    const TraceSphere sphere = on_sphere ? geometry.spheres[start] : TraceSphere{Vec3d(kNan), kNan};
    packet->start_sphere[0][lane] = sphere.center.x;
    packet->start_sphere[1][lane] = sphere.center.y;
    packet->start_sphere[2][lane] = sphere.center.z;
    packet->start_sphere[3][lane] = sphere.radius;
    packet->start_extent[lane] = geometry.triangles.empty() ? 0 : Reach(geometry, start);
  }
}

void Occluded(const TraceScene& scene, ShadowRayBatch* rays) {
  Packet packet;
  InitPacket(scene, &packet);
  const size_t width = packet.Width();
  for (size_t first = 0; first < rays->count; first += width) {
    packet.t_max = rays->t_max.data() + first;
    packet.outward = rays->outward;
    packet.target = rays->target;
    packet.camera_extent = rays->camera_extent;
    packet.occluded = 0;
    FillPacket(*rays, first, &packet);
    FillStarts(*rays, first, &packet);
    OccludedPacket(packet.width, packet.valid, packet.scene, &packet.context, &packet.rays);
    for (size_t lane = 0; lane < width; ++lane) {
      rays->occluded[first + lane] = (packet.occluded >> lane) & 1;
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(Nearer);
HWY_EXPORT(Occluded);

void TraceClosest(const TraceScene& scene, const RayBatch& rays, ClosestHits* hits) {
  std::fill(hits->t.begin(), hits->t.end(), std::numeric_limits<double>::infinity());
  TraceNearer(scene, rays, hits);
}

void TraceNearer(const TraceScene& scene, const RayBatch& rays, ClosestHits* hits) {
  HWY_DYNAMIC_DISPATCH(Nearer)(scene, rays, hits);
}

void TraceOccluded(const TraceScene& scene, ShadowRayBatch* rays) {
  HWY_DYNAMIC_DISPATCH(Occluded)(scene, rays);
}
}  // namespace nacre
#endif
