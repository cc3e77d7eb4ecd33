// SPDX-License-Identifier: Apache-2.0
// render/tile_sight.h: which of the scene's shapes the rays of one tile may hit, found before any
// of them is traced.
#pragma once

#include "base/image.h"
#include "render/hits_plan.h"
#include "visibility/tile_kernel.h"

namespace nacre {

struct TileSight {
  bool shapes = false;     // anything at all
  bool triangles = false;  // of meshes
  bool positions = true;   // hits are to have HitBatch::position
  TileCandidates spheres;  // valid where HitsPlan::binned
};

// `tile` lies within one row of cells (visibility/sphere_bins.h).
void FindSight(const HitsPlan& plan, const Window& tile, TileSight* sight);

}  // namespace nacre
