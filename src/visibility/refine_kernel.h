// SPDX-License-Identifier: Apache-2.0
// visibility/refine_kernel.h: computes the points and normals that are shaded, from closest hits.
#pragma once

#include "hit/batch.h"
#include "visibility/geometry.h"
#include "visibility/two_product.h"

namespace nacre {

// The arguments of Intersector::Refine.
struct RefineRequest {
  const TraceGeometry& geometry;
  const RayBatch& rays;
  const ClosestHits& closest;
  const uint32_t* ray_indices;
  size_t count;
};

void RefineHits(const RefineRequest& request, const HitOutput& to);

// The t of a camera ray on a sphere that it is known to hit, as Closest finds it.
double DepthOn(const TraceSphere& sphere, const RayBatch& rays, size_t ray);

// Whether the active target fuses products, for the scalar twins of the hit tests.
Products TargetProducts();

}  // namespace nacre
