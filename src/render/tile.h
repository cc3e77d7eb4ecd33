// render/tile.h: the work on one tile: samples, rays, hits, light, film.
#pragma once

#include "render/film.h"
#include "render/plan.h"
#include "render/stats.h"

namespace nacre {

// Hits [begin, end) of a batch share a material.
struct MaterialRun {
  MaterialId material;
  size_t begin, end;
};

// Buffers of one worker, reused from tile to tile.
struct TileScratch {
  // Samples of a round, per ray.
  AlignedArray<double> film_x{kBatchCapacity}, film_y{kBatchCapacity}, weight{kBatchCapacity};
  RayBatch rays;
  TileCandidates candidates;
  ClosestHits closest;
  // Hits sorted into runs.
  AlignedArray<uint32_t> hit_rays{kBatchCapacity};
  std::vector<MaterialRun> runs;
  std::vector<uint32_t> run_of_material;  // index into runs, or none, per material of the scene
  AlignedArray<uint32_t> run_of_ray{kBatchCapacity};
  HitBatch hits;
  Surface surface;
  LightBatch light;
  NarrowLobes narrow;
  std::vector<LightOnBatch> together;  // lights shaded by in one go
  ShadowRayBatch shadow_rays;
  AlignedArray<uint32_t> shadow_hits{kBatchCapacity};
  ReflectedRadiance total;             // of all lights
  ReflectedRadiance single;            // of one light, where a layer wants it
  std::vector<Soa3<float>> per_light;  // one for each light layer, per hit
  // A round on its way to the film, per ray.
  Soa3<double> ray_values;                            // of one layer
  AlignedArray<uint32_t> hit_of_ray{kBatchCapacity};  // index into hits, or none
};

// Renders the pixels of `tile`, which lies within the film's strip, into the film.
void RenderTile(const RenderPlan& plan, const Window& tile, TileScratch* scratch, StripFilm* film,
                RenderStats* stats);

}  // namespace nacre
