// SPDX-License-Identifier: Apache-2.0
// embree/embree_packet.h: a packet in the form that Embree traces, with access for its callbacks.
#pragma once

#include <cstdint>

#include "embree/embree_api.h"
#include "visibility/packet.h"

namespace nacre {

// The packet's float rays are those in `rays`, whose origins are relative to the BVH's origin.
struct EmbreePacket {
  EmbreePacket(int width, RTCScene scene, const TraceGeometry* geometry);
  EmbreePacket(const EmbreePacket&) = delete;  // it points into itself
  EmbreePacket& operator=(const EmbreePacket&) = delete;

  EmbreeContext context;  // first: the callbacks get a pointer to it and find the packet
  RTCScene scene;
  alignas(64) int valid[kMaxPacketWidth];  // -1: the lane is active, 0: it is not
  RTCRayHit16 rays;                        // laid out for the packet's width
  Packet packet;

  RTCRayN* ray_n() { return RTCRayHitN_RayN(reinterpret_cast<RTCRayHitN*>(&rays), Width()); }
  unsigned Width() const { return static_cast<unsigned>(packet.width); }
};

inline EmbreePacket::EmbreePacket(int width, RTCScene to_scene, const TraceGeometry* geometry)
    : scene(to_scene) {
  InitContext(&context);
  packet.width = width;
  packet.geometry = geometry;
  const unsigned lanes = Width();
  RTCRayN* ray = ray_n();
  packet.floats = {
      {&RTCRayN_dir_x(ray, lanes, 0), &RTCRayN_dir_y(ray, lanes, 0), &RTCRayN_dir_z(ray, lanes, 0)},
      &RTCRayN_tfar(ray, lanes, 0)};
  auto* hits = RTCRayHitN_HitN(reinterpret_cast<RTCRayHitN*>(&rays), lanes);
  for (unsigned i = 0; i < lanes; ++i) {
    RTCRayN_tnear(ray, lanes, i) = 0;
    RTCRayN_time(ray, lanes, i) = 0;
    RTCRayN_mask(ray, lanes, i) = ~0u;
    RTCRayN_id(ray, lanes, i) = i;
    RTCRayN_flags(ray, lanes, i) = 0;
    RTCHitN_geomID(hits, lanes, i) = RTC_INVALID_GEOMETRY_ID;
    RTCHitN_instID(hits, lanes, i, 0) = RTC_INVALID_GEOMETRY_ID;
  }
}

inline EmbreePacket& PacketOf(EmbreeContext* context) {
  return *reinterpret_cast<EmbreePacket*>(context);
}

// The lanes, as bits, of the rays that a callback is to test. Embree passes the packet itself, or a
// copy of some of its rays in another order, in which their ids tell the lanes.
inline uint32_t ActiveLanes(const EmbreePacket& packet, const int* valid, const void* rays,
                            unsigned count) {
  uint32_t lanes = 0;
  if (rays == &packet.rays) {
    for (unsigned i = 0; i < count; ++i) lanes |= static_cast<uint32_t>(valid[i] != 0) << i;
    return lanes;
  }
  auto* copy = static_cast<RTCRayN*>(const_cast<void*>(rays));
  for (unsigned i = 0; i < count; ++i) {
    if (valid[i] != 0) lanes |= 1u << RTCRayN_id(copy, count, i);
  }
  return lanes;
}

// Copies the packet's depth limits to the rays that a callback was given.
inline void ReturnDepths(const EmbreePacket& packet, const int* valid, void* rays, unsigned count) {
  if (rays == &packet.rays) return;
  auto* copy = static_cast<RTCRayN*>(rays);
  const float* const depth = packet.packet.floats.depth;
  for (unsigned i = 0; i < count; ++i) {
    if (valid[i] != 0) RTCRayN_tfar(copy, count, i) = depth[RTCRayN_id(copy, count, i)];
  }
}

}  // namespace nacre
