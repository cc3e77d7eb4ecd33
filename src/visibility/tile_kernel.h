// SPDX-License-Identifier: Apache-2.0
// visibility/tile_kernel.h: camera rays of a tile against the spheres binned to its cells: from
// film positions to hits ready for shading in one call.
#pragma once

#include <vector>

#include "hit/batch.h"
#include "visibility/projected_sphere_test.h"
#include "visibility/sphere_bins.h"

namespace nacre {

// A sphere that rays of a tile may hit.
struct TileCandidate {
  TraceSphere sphere;
  double radius2;
  const ProjectedSphere* projected = nullptr;  // if UsesProjectedTest
  uint32_t primitive;
  uint16_t pixel_rows;          // pixel rows of its cell that its outline covers, as bits
  bool in_cell_before = false;  // it is also in the tile's cell to the left
  bool around_camera;           // the camera is inside of it
  bool in_front;                // no perspective ray's line meets it behind the camera
  // For the conservative test in float: no ray meets the sphere nearer to the camera than `near`,
  // and rays that hit it pass `center` within `radius_bound`, the radius plus the rounding errors.
  float near;
  float center[3];
  float radius_bound;
};

// Consecutive pixels of a row of a tile whose rays may hit something.
struct PixelSpan {
  uint32_t first, count;  // pixels of the tile are numbered row by row
  // The only sphere that their rays may hit, if it is in front of the camera; null: any spheres.
  const TileCandidate* single_sphere;
};

// The rays that a tile is traced with: one sample after the other of each of its pixels, or of each
// of those in TileCandidates::spans, row by row (FilmBatch::pixels); or any rays in any order,
// which requires that the tile lies in one cell.
enum class TileRays : uint8_t { kSamples, kAny };

// The candidates of each of a tile's cells, the cells from left to right, the candidates nearest
// first. Each worker has one and reuses it for all its tiles.
struct TileCandidates {
  Window tile;
  TileRays rays = TileRays::kSamples;
  int first_column = 0;  // column of the first cell
  size_t spheres = 0;    // number of spheres, each counted once
  std::vector<std::vector<TileCandidate>> cells;
  std::vector<ProjectedSphere> projected;  // what TileCandidate::projected points to
  std::vector<PixelSpan> spans;            // for kSamples, in the order of the pixels
};

// Fills `candidates` for a tile that lies within one row of cells; false if there are none.
bool GatherTile(const TraceGeometry& geometry, const SphereBins& bins, const CameraFrame& frame,
                const Window& tile, TileRays rays, TileCandidates* candidates);

// The first hits of the camera rays through `film`, in the order of the rays.
void TraceTile(const CameraFrame& frame, const SphereBins& bins, const TileCandidates& candidates,
               const FilmBatch& film, const HitOutput& to);

}  // namespace nacre
