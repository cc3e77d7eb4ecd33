// SPDX-License-Identifier: Apache-2.0
// embree/primitives.h: Embree's callbacks for spheres and triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "embree/embree_api.h"
#include "visibility/geometry.h"

namespace nacre {

struct PrimitiveCallbacks {
  RTCIntersectFunctionN intersect;
  RTCOccludedFunctionN occluded;
};

// The callbacks of a user geometry whose primitives are TraceGeometry::spheres and whose user
// pointer leads to the TraceGeometry, compiled for the active target. Queries must pass an
// EmbreePacket as context.
PrimitiveCallbacks SphereCallbacks();

// The triangles of a geometry as Embree's primitives: each is one triangle, or two consecutive ones
// that share an edge, as the halves of a quad do. A BVH of half as many boxes is built in little
// more than half the time.
struct TrianglePrimitives {
  const TraceGeometry* geometry = nullptr;
  std::vector<uint32_t> first;  // each primitive's first triangle; then the number of triangles

  size_t size() const { return first.size() - 1; }
};

TrianglePrimitives MakeTrianglePrimitives(const TraceGeometry* geometry);

// The callbacks of a user geometry whose user pointer leads to TrianglePrimitives; see
// SphereCallbacks.
PrimitiveCallbacks TriangleCallbacks();

}  // namespace nacre
