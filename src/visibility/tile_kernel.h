// SPDX-License-Identifier: Apache-2.0
// visibility/tile_kernel.h: camera rays of a tile against the spheres binned to its cells: from
// film positions to hits ready for shading, without a stop on the way.
#pragma once

#include <vector>

#include "hit/batch.h"
#include "visibility/film_test.h"
#include "visibility/sphere_bins.h"

namespace nacre {

// A sphere that a tile's rays may hit.
struct TileCandidate {
  TraceSphere sphere;
  double radius2;
  const FilmSphere* film = nullptr;  // if HasFilmPlace
  uint32_t primitive;
  uint16_t pixel_rows;          // of its cell that its outline reaches, as bits
  bool in_cell_before = false;  // it is in the tile's cell to the left, too
  bool around_camera;           // the camera is inside
  bool in_front;                // no perspective ray's line meets it behind the camera
  // For proposals, in float: no ray meets the sphere nearer to the camera than `near`, and rays
  // that hit it come within `reach` of `center`: radius and rounding errors.
  float near;
  float center[3];
  float reach;
};

// Pixels of a row of a tile that rays may hit something in.
struct PixelSpan {
  uint32_t first, count;       // counted row by row
  const TileCandidate* alone;  // the only sphere that they may hit, in front; null: any
};

// Which rays come of a tile: whole samples of its pixels, row by row, or any in any order, where
// the tile lies in one cell.
enum class TileRays : uint8_t { kSamples, kAny };

// The candidates of each of a tile's cells, from left to right, nearest first. One for each worker,
// reused from tile to tile.
struct TileCandidates {
  Window tile;
  TileRays rays = TileRays::kSamples;
  int first_column = 0;  // of cells
  size_t spheres = 0;    // in all, each counted once
  std::vector<std::vector<TileCandidate>> cells;
  std::vector<FilmSphere> film;          // what they point to
  std::vector<PixelSpan> spans;          // of samples: in the order of the pixels
  const TileCandidate* alone = nullptr;  // the spans', if the tile has one sphere
};

// Fills `candidates` for a tile that lies within one row of cells; false if there are none.
bool GatherTile(const TraceGeometry& geometry, const SphereBins& bins, const CameraFrame& frame,
                const Window& tile, TileRays rays, TileCandidates* candidates);

// The first hits of the camera rays through `film`, in the order of the rays.
void TraceTile(const CameraFrame& frame, const SphereBins& bins, const TileCandidates& candidates,
               const FilmBatch& film, const HitsTo& to);

}  // namespace nacre
