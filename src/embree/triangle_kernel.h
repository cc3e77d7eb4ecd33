// SPDX-License-Identifier: Apache-2.0
// embree/triangle_kernel.h: Embree's callbacks for the triangles.
#pragma once

#include "embree/sphere_kernel.h"

namespace nacre {

// As SphereCallbacks, for TraceGeometry::triangles.
PrimitiveCallbacks TriangleCallbacks();

}  // namespace nacre
