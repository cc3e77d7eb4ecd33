// visibility/tile_kernel.h: camera rays of a tile against the spheres binned to its cells.
#pragma once

#include <vector>

#include "hit/batch.h"
#include "visibility/sphere_bins.h"

namespace nacre {

// A sphere that a tile's rays may hit.
struct TileCandidate {
  TraceSphere sphere;
  uint32_t primitive;
  float near;  // no ray meets the sphere nearer to the camera than this
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

// The closest hits of the rays through `samples` samples of each of the tile's pixels, row by row.
void TraceTile(const TraceGeometry& geometry, const SphereBins& bins,
               const TileCandidates& candidates, int samples, const RayBatch& rays,
               ClosestHits* hits);

}  // namespace nacre
