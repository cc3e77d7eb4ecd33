// SPDX-License-Identifier: Apache-2.0
// embree/sphere_kernel.h: Embree's callbacks for the spheres.
#pragma once

#include "embree/embree_api.h"

namespace nacre {

struct PrimitiveCallbacks {
  RTCIntersectFunctionN intersect;
  RTCOccludedFunctionN occluded;
};

// For one user geometry whose primitives are TraceGeometry::spheres and whose user pointer is the
// TraceGeometry; compiled for the active target. Queries must come with an EmbreePacket as context.
PrimitiveCallbacks SphereCallbacks();

}  // namespace nacre
