// SPDX-License-Identifier: Apache-2.0
// visibility/shell_kernel.h: batches of rays through the tree of shells, packet by packet.
#pragma once

#include "hit/batch.h"
#include "visibility/geometry.h"

namespace nacre {

// Puts the rays' first hits on spheres in the place of those that they are nearer than.
void NearerInShells(const TraceGeometry& geometry, const RayBatch& rays, ClosestHits* hits);

// Sets rays->occluded where a sphere is in the way; the others stay.
void OccludedInShells(const TraceGeometry& geometry, ShadowRayBatch* rays);

}  // namespace nacre
