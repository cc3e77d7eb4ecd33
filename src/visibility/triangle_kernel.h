// SPDX-License-Identifier: Apache-2.0
// visibility/triangle_kernel.h: Embree's callbacks for the triangles.
#pragma once

#include "visibility/sphere_kernel.h"

namespace nacre {

// As SphereCallbacks, for TraceGeometry::triangles.
PrimitiveCallbacks TriangleCallbacks();

}  // namespace nacre
