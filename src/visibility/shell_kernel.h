// SPDX-License-Identifier: Apache-2.0
// visibility/shell_kernel.h: traces batches of rays through the shell tree, packet by packet.
#pragma once

#include "hit/batch.h"
#include "visibility/geometry.h"

namespace nacre {

// Finds the rays' first hits on spheres, and replaces those in `hits` that are farther.
void NearerInShells(const TraceGeometry& geometry, const RayBatch& rays, ClosestHits* hits);

// Sets rays->occluded where a sphere occludes the ray; leaves the others as they are.
void OccludedInShells(const TraceGeometry& geometry, ShadowRayBatch* rays);

}  // namespace nacre
