// SPDX-License-Identifier: Apache-2.0
// render/hits.h: the second stage: the first hits of a tile's camera rays, found by bins or by a
// tree, or on spheres by bins and on triangles by a tree, the nearer of both.
#pragma once

#include <memory>

#include "hit/batch.h"
#include "render/hits_plan.h"
#include "render/tile_sight.h"

namespace nacre {

// In the order of the rays.
struct CameraHits {
  HitBatch batch;
  HitDirections directions;
  bool positions = false;  // batch.position is filled
  bool exact = false;      // batch.normal and to_view are
};

// Buffers of TraceCamera.
struct TraceRoom {
  RayBatch rays;
  ClosestHits closest;
  AlignedArray<uint32_t> hit_rays{kBatchCapacity};
  // Where there are triangles and bins: hits on triangles, hits on spheres that a triangle hides
  // (1), and both kinds joined.
  struct Triangles {
    CameraHits hits, joined;
    AlignedArray<uint8_t> hides_sphere{kBatchCapacity};
  };
  std::unique_ptr<Triangles> triangles;  // made for the first such tile
};

// The hits of the camera rays through `film` in a tile that FindSight has seen.
void TraceCamera(const HitsPlan& plan, const TileSight& sight, const FilmBatch& film,
                 TraceRoom* room, CameraHits* hits);

}  // namespace nacre
