// SPDX-License-Identifier: Apache-2.0
// render/tile_hits.h: the hits of a tile's camera rays: by bins or by Embree, or on spheres by bins
// and on triangles by Embree, the nearer of both.
#pragma once

#include "hit/batch.h"
#include "render/plan.h"

namespace nacre {

struct TileScratch;

// Buffers for hits on triangles before they join those on spheres.
struct TriangleHits {
  HitBatch hits;
  HitDirections directions;
  AlignedArray<uint32_t> rays{kBatchCapacity};
  AlignedArray<uint8_t> hidden{kBatchCapacity};  // per hit on a sphere: 1 if a triangle hides it
};

// Finds what shapes a tile's rays may hit; false if none.
bool EnterShapes(const RenderPlan& plan, const Window& tile, TileScratch* scratch);

// The hits of the camera rays through the scratch's samples, in the order of the rays.
void FindHits(const RenderPlan& plan, TileScratch* scratch);

}  // namespace nacre
