// SPDX-License-Identifier: Apache-2.0
// visibility/refine_kernel.h: from closest hits to points and normals to shade.
#pragma once

#include "hit/batch.h"
#include "visibility/geometry.h"

namespace nacre {

// The arguments of Intersector::Refine.
struct RefineRequest {
  const TraceGeometry& geometry;
  const RayBatch& rays;
  const ClosestHits& closest;
  const uint32_t* ray_indices;
  size_t count;
};

void RefineHits(const RefineRequest& request, const HitsTo& to);

}  // namespace nacre
