// SPDX-License-Identifier: Apache-2.0
// visibility/packet.h: one packet of rays on its way through a tree: the float rays that spheres
// are proposed by, and what decides hits in double.
#pragma once

#include <cstdint>

#include "hit/camera_frame.h"
#include "scene/light_shapes.h"
#include "visibility/geometry.h"

namespace nacre {

inline constexpr int kMaxPacketWidth = 16;

// The rays of a packet rounded to float, one a lane, where its tree reads them.
struct FloatRays {
  float* origin_x;
  float* origin_y;
  float* origin_z;
  float* direction_x;
  float* direction_y;
  float* direction_z;
  float* depth;  // where the rays end: t times Packet::t_scale, or more
};

// Lanes are numbered as in the batch that the packet is a piece of; the pointers are to the
// packet's piece of the batch's arrays.
struct Packet {
  int width = 0;       // 4, 8 or 16
  uint32_t lanes = 0;  // one bit a lane that holds a ray whose answer is open
  const TraceGeometry* geometry = nullptr;
  ProjectedTestView view;  // the batch's
  FloatRays floats{};

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

  bool holes_are_solid = false;  // RayBatch's

  // Where rays start: of shadow rays, and of a RayBatch if its rays leave surfaces.
  bool from_surfaces = false;
  alignas(64) uint32_t start[kMaxPacketWidth];  // primitive that the ray starts on
  // If that is a sphere, its centre and radius, so that spheres that coincide with it are
  // recognised; else NaN.
  alignas(64) double start_sphere[4][kMaxPacketWidth];
  alignas(64) double start_extent[kMaxPacketWidth];  // upper bound of that primitive's coordinates

  // Occlusion queries.
  bool outward = false;      // ShadowRayBatch's
  PrimitiveRange target;     // likewise
  double camera_extent = 0;  // likewise
  uint32_t occluded = 0;     // one bit a lane
};

}  // namespace nacre
