// SPDX-License-Identifier: Apache-2.0
// visibility/tile_candidates.h: the spheres that camera rays of a tile may hit, and where.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/image.h"
#include "visibility/geometry.h"
#include "visibility/projected_sphere_test.h"

namespace nacre {

// A sphere that rays of a tile may hit.
struct TileCandidate {
  TraceSphere sphere;
  double radius2;
  const ProjectedSphere* projected = nullptr;  // if UsesProjectedTest
  uint32_t primitive;
  uint16_t pixel_rows;          // pixel rows of its cell that the outline covers, as bits
  bool in_cell_before = false;  // also listed in the tile's cell to the left
  bool around_camera;           // the camera is inside the sphere
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

// The rays that a tile is traced with. kSamples: sample by sample, a ray for each of its pixels, or
// for each of those in TileCandidates::spans, row by row (FilmBatch::pixels). kAny: any rays in any
// order, which requires that the tile lies in one cell.
enum class TileRays : uint8_t { kSamples, kAny };

// The candidates of each of a tile's cells. Cells go from left to right, candidates from near to
// far. Each worker has one of these and reuses it for all its tiles.
struct TileCandidates {
  Window tile;
  TileRays rays = TileRays::kSamples;
  int first_column = 0;  // column of the first cell
  size_t spheres = 0;    // number of spheres, each counted once
  std::vector<std::vector<TileCandidate>> cells;
  std::vector<ProjectedSphere> projected;  // what TileCandidate::projected points to
  std::vector<PixelSpan> spans;            // for kSamples, in the order of the pixels
};

}  // namespace nacre
