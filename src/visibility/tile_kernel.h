// SPDX-License-Identifier: Apache-2.0
// visibility/tile_kernel.h: camera rays of a tile against the spheres binned to its cells: from
// film positions to hits ready for shading, without a stop on the way.
#pragma once

#include <vector>

#include "hit/batch.h"
#include "visibility/sphere_bins.h"

namespace nacre {

// A sphere that a tile's rays may hit.
struct TileCandidate {
  TraceSphere sphere;
  double inverse_radius;
  uint32_t primitive;
  bool around_camera;  // the camera is inside
  // For proposals, in float: no ray meets the sphere nearer to the camera than `near`, and rays
  // that hit it come within `reach` of `center`: radius and rounding errors.
  float near;
  float center[3];
  float reach;
};

// The candidates of each of a tile's cells, from left to right, nearest first. One for each worker,
// reused from tile to tile.
struct TileCandidates {
  Window tile;
  int first_column = 0;  // of cells
  std::vector<std::vector<TileCandidate>> cells;
};

// Fills `candidates` for a tile that lies within one row of cells; false if there are none.
bool GatherTile(const TraceGeometry& geometry, const SphereBins& bins, const CameraFrame& frame,
                const Window& tile, TileCandidates* candidates);

// The first hits of the camera rays through `film`, in the order of the rays. They are whole
// samples of the tile's pixels, or any rays through the one cell that the tile lies in.
void TraceTile(const CameraFrame& frame, const SphereBins& bins, const TileCandidates& candidates,
               const FilmBatch& film, const HitsTo& to);

}  // namespace nacre
