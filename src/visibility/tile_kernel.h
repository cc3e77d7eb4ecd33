// SPDX-License-Identifier: Apache-2.0
// visibility/tile_kernel.h: traces camera rays of a tile against the spheres binned to its cells,
// from film positions to hits ready for shading in one call.
#pragma once

#include "hit/batch.h"
#include "visibility/sphere_bins.h"
#include "visibility/tile_candidates.h"

namespace nacre {

// Fills `candidates` for a tile that lies within one row of cells; returns false if there are none.
bool GatherTile(const TraceGeometry& geometry, const SphereBins& bins, const CameraFrame& frame,
                const Window& tile, TileRays rays, TileCandidates* candidates);

// Fills candidates->spans, which must be empty: the pixels that each sphere's outline covers in
// each row of the tile. Where outlines do not overlap, a ray needs the exact test of only one
// sphere. The tile has at most kCellSize rows.
void FindPixelSpans(const SphereBins& bins, TileCandidates* candidates);

// Finds the first hits of the camera rays through `film`, in the order of the rays.
void TraceTile(const CameraFrame& frame, const SphereBins& bins, const TileCandidates& candidates,
               const FilmBatch& film, const HitOutput& to);

}  // namespace nacre
