// SPDX-License-Identifier: Apache-2.0
// embree/sphere_kernel.h: Embree's callbacks for spheres.
#pragma once

#include "embree/embree_api.h"

namespace nacre {

struct PrimitiveCallbacks {
  RTCIntersectFunctionN intersect;
  RTCOccludedFunctionN occluded;
};

// The callbacks of a user geometry whose primitives are TraceGeometry::spheres and whose user
// pointer leads to the TraceGeometry, compiled for the active target. Queries must pass an
// EmbreePacket as context.
PrimitiveCallbacks SphereCallbacks();

}  // namespace nacre
