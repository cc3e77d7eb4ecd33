// SPDX-License-Identifier: Apache-2.0
// visibility/packet.h: one packet of rays on its way through Embree: the float rays that Embree
// walks its tree with, and what our callbacks need to decide hits in double.
#pragma once

#include <cstdint>

#include "hit/camera_frame.h"
#include "scene/light_shapes.h"
#include "visibility/embree_api.h"
#include "visibility/geometry.h"

namespace nacre {

inline constexpr int kMaxPacketWidth = 16;

// Lanes are numbered as in the batch that the packet is a piece of; the pointers are to the
// packet's piece of the batch's arrays. Embree's depths are t times t_scale.
struct Packet {
  EmbreeContext context;  // first: the callbacks get a pointer to it and find the packet
  int width = 0;
  RTCScene scene = nullptr;
  const TraceGeometry* geometry = nullptr;
  ProjectedTestView view;  // the batch's

  alignas(64) int valid[kMaxPacketWidth];  // -1: the lane holds a ray, 0: not
  RTCRayHit16 rays;                        // laid out for `width` lanes

  const double* origin_x;
  const double* origin_y;
  const double* origin_z;
  const double* direction_x;
  const double* direction_y;
  const double* direction_z;

  alignas(64) double inverse_dd[kMaxPacketWidth];  // 1 / |direction|^2
  alignas(64) double t_scale[kMaxPacketWidth];     // the power of two that direction was divided by
  alignas(64) double shear[6][kMaxPacketWidth];    // RayShear; if there are triangles

  // Of the float rays, for the sphere proposal.
  alignas(64) float ray_inverse_dd[kMaxPacketWidth];
  alignas(64) float ray_inverse_length[kMaxPacketWidth];  // an upper bound
  alignas(64) float origin_error[kMaxPacketWidth];

  const double* t_max = nullptr;  // where the rays end
  // Closest queries: the best hit so far, at t_max.
  double* best_t = nullptr;
  uint32_t* best_primitive = nullptr;

  // Occlusion queries.
  bool outward = false;                         // ShadowRayBatch's
  PrimitiveRange target;                        // likewise
  double camera_extent = 0;                     // likewise
  alignas(64) uint32_t start[kMaxPacketWidth];  // primitive that the ray starts on
  // If that is a sphere, its centre and radius, so that spheres that coincide with it are
  // recognised; else NaN.
  alignas(64) double start_sphere[4][kMaxPacketWidth];
  alignas(64) double start_extent[kMaxPacketWidth];  // upper bound of that primitive's coordinates
  uint32_t occluded = 0;                             // one bit a lane

  RTCRayN* ray_n() { return RTCRayHitN_RayN(reinterpret_cast<RTCRayHitN*>(&rays), Width()); }
  unsigned Width() const { return static_cast<unsigned>(width); }
  float* tfar() { return &RTCRayN_tfar(ray_n(), Width(), 0); }
};

inline Packet& PacketOf(EmbreeContext* context) { return *reinterpret_cast<Packet*>(context); }

// The lanes, as bits, of the rays that a callback is asked about. Embree passes the packet itself,
// or a copy of some of its rays in another order: ids lead back.
inline uint32_t ActiveLanes(Packet& packet, const int* valid, const void* rays, unsigned count) {
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

// Hands the packet's depth limits to the rays that a callback was given.
inline void ReturnDepths(Packet& packet, const int* valid, void* rays, unsigned count) {
  if (rays == &packet.rays) return;
  auto* copy = static_cast<RTCRayN*>(rays);
  for (unsigned i = 0; i < count; ++i) {
    if (valid[i] != 0) RTCRayN_tfar(copy, count, i) = packet.tfar()[RTCRayN_id(copy, count, i)];
  }
}

}  // namespace nacre
