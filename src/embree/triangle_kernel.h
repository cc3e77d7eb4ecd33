// SPDX-License-Identifier: Apache-2.0
// embree/triangle_kernel.h: Embree's callbacks for the triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "embree/sphere_kernel.h"
#include "visibility/geometry.h"

namespace nacre {

// The triangles of a geometry as Embree's primitives: each is one triangle, or two that follow one
// another and share an edge, as the halves of a quad do. A tree of half as many boxes is made in
// little more than half the time.
struct TrianglePrimitives {
  const TraceGeometry* geometry = nullptr;
  std::vector<uint32_t> first;  // each primitive's first triangle; and how many triangles there are

  size_t size() const { return first.size() - 1; }
};

TrianglePrimitives MakeTrianglePrimitives(const TraceGeometry* geometry);

// As SphereCallbacks, for a user pointer to TrianglePrimitives.
PrimitiveCallbacks TriangleCallbacks();

}  // namespace nacre
