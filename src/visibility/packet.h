// SPDX-License-Identifier: Apache-2.0
// visibility/packet.h: a packet of rays during the traversal of a BVH: float rays, which find
// boxes, and the terms of the exact tests in double.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "hit/camera_frame.h"
#include "scene/primitive_range.h"
#include "visibility/geometry.h"

namespace nacre {

inline constexpr int kMaxPacketWidth = 16;

// Directions and limits of a packet's rays rounded to float, one per lane, where its BVH reads
// them.
struct FloatRays {
  float* direction[3];
  float* depth;  // limits of the rays: t times Packet::t_scale, rounded up
};

// Stands for the start of rays that start on no sphere. It coincides with none.
inline const TraceSphere kNoSphere{Vec3d(std::numeric_limits<double>::quiet_NaN()), 0};

// The spheres that rays start on, by which spheres that coincide with them are recognised.
struct StartSpheres {
  alignas(64) double center[3][kMaxPacketWidth];
  alignas(64) double radius[kMaxPacketWidth];

  void Set(size_t lane, const TraceSphere& sphere) {
    for (int c = 0; c < 3; ++c) center[c][lane] = sphere.center[c];
    radius[lane] = sphere.radius;
  }
};

// Lanes are numbered as in the batch that the packet is a piece of. Pointers lead to the packet's
// piece of the batch's arrays.
struct Packet {
  int width = 0;       // 4, 8 or 16
  uint32_t lanes = 0;  // one bit per lane that holds a ray which is still to be decided
  const TraceGeometry* geometry = nullptr;
  ProjectedTestView view;  // from the batch
  FloatRays floats{};

  const double* origin[3];
  const double* direction[3];

  alignas(64) double inverse_dd[kMaxPacketWidth];  // 1 / |direction|^2
  alignas(64) double t_scale[kMaxPacketWidth];     // power of two that direction was divided by
  alignas(64) double shear[6][kMaxPacketWidth];    // RayShear, if there are triangles

  const double* t_max = nullptr;  // limits of the rays
  // For closest hits: the best hit so far. best_t is t_max.
  double* best_t = nullptr;
  uint32_t* best_primitive = nullptr;

  bool holes_are_solid = false;  // from the RayBatch

  // Where the rays start, for shadow rays, and for a RayBatch whose rays leave surfaces.
  bool from_surfaces = false;
  alignas(64) uint32_t start[kMaxPacketWidth];  // primitive that the ray starts on
  const double* own_after = nullptr;            // from the batch
  StartSpheres start_spheres;
  alignas(64) double start_extent[kMaxPacketWidth];  // upper bound of that primitive's coordinates

  // For shadow rays.
  PrimitiveRange target;     // from the ShadowRayBatch
  double camera_extent = 0;  // from the ShadowRayBatch
  uint32_t occluded = 0;     // one bit per lane
};

}  // namespace nacre
