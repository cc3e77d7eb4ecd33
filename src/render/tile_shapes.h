// SPDX-License-Identifier: Apache-2.0
// render/tile_shapes.h: finds the shapes that the rays of a tile may hit, before any of them is
// traced.
#pragma once

#include "base/image.h"
#include "render/hits_plan.h"
#include "visibility/tile_kernel.h"

namespace nacre {

struct TileShapes {
  bool any = false;        // rays may hit anything at all
  bool triangles = false;  // rays may hit triangles
  bool positions = true;   // hits need HitBatch::position
  TileCandidates spheres;  // that rays may hit; valid if TracePlan::binned
};

// `tile` must lie within one row of cells (visibility/sphere_bins.h).
void FindTileShapes(const HitsPlan& plan, const Window& tile, TileShapes* shapes);

}  // namespace nacre
