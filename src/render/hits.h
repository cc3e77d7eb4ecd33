// SPDX-License-Identifier: Apache-2.0
// render/hits.h: the second stage: finds the first hit of each camera ray of a tile. Spheres are
// found by bins, triangles by a BVH, and the nearer hit counts; without bins a BVH finds both.
#pragma once

#include <memory>

#include "hit/batch.h"
#include "render/hits_plan.h"
#include "render/tile_shapes.h"

namespace nacre {

// Hits in the order of their rays.
struct CameraHits {
  HitBatch batch;
  HitDirections directions;
  bool has_positions = false;         // batch.position is filled
  bool has_exact_directions = false;  // batch.normal and batch.to_view are filled
};

// Buffers of TraceCamera.
struct TraceRoom {
  RayBatch rays;
  ClosestHits closest;
  AlignedArray<uint32_t> hit_rays{kBatchCapacity};
  // For tiles in which both binned spheres and triangles may be visible: the hits on triangles, the
  // joined hits, and by hit on a sphere whether a triangle hides it (1).
  struct Triangles {
    CameraHits hits, joined;
    AlignedArray<uint8_t> hides_sphere{kBatchCapacity};
  };
  std::unique_ptr<Triangles> triangles;  // made for the first such tile
};

// Finds the hits of the camera rays through `film` in a tile. `shapes` comes from FindTileShapes.
void TraceCamera(const HitsPlan& plan, const TileShapes& shapes, const FilmBatch& film,
                 TraceRoom* room, CameraHits* hits);

}  // namespace nacre
