// SPDX-License-Identifier: Apache-2.0
// render/tile.h: the work on one tile: samples, rays, hits, light, film.
#pragma once

#include <memory>

#include "render/film.h"
#include "render/film_kernel.h"
#include "render/mapped_horizon.h"
#include "render/plan.h"
#include "render/sampled_lights.h"
#include "render/stage_clock.h"
#include "render/tile_hits.h"

namespace nacre {

// Hits [begin, end) of a batch share a material.
struct MaterialRun {
  MaterialId material;
  size_t begin, end;
  bool interpolated;  // they reflect what is kept in RenderPlan::mesh_radiance
};

// Buffers of one worker, reused from tile to tile.
struct TileScratch {
  TileFilm film;
  // Samples of a round.
  std::vector<PixelRun> sampled_runs;
  PixelBatch sampled_pixels{kBatchCapacity};
  FilmBatch samples;
  std::vector<double> weights;
  bool in_sight = true;  // some of the scene's shapes may be behind the samples
  // Camera rays: by bins, or by Embree.
  bool triangles_in_sight = true;  // likewise, of meshes
  bool positions = true;           // hits are asked where they lie
  TileCandidates candidates;
  RayBatch rays;
  ClosestHits closest;
  AlignedArray<uint32_t> hit_rays{kBatchCapacity};
  // Hits, and room to sort them by material.
  HitBatch hits, unsorted_hits;
  Surface surface;
  HitDirections unsorted_directions;
  std::unique_ptr<TriangleHits> triangle_hits;  // made for the first tile with triangles and bins
  std::vector<MaterialRun> runs;
  // Index into runs, or none, per material of the scene; then the same of interpolated runs.
  std::vector<uint32_t> run_of_material;
  AlignedArray<uint32_t> run_of_hit{kBatchCapacity};
  AlignedArray<uint32_t> order{kBatchCapacity};
  std::unique_ptr<HitTextures> textures;  // made for the first hit on a material with maps
  LightBatch light;
  NarrowLobes narrow;
  std::unique_ptr<MirroredLobe> mirrored;   // made for the first lobe about a turned normal
  std::vector<LightOnBatch> together;       // lights shaded by in one go
  std::unique_ptr<SampledScratch> sampled;  // where the plan has sampled lights
  Soa3<double> shadow_origin;               // of the hits, where the plan lifts some
  ShadowRayBatch shadow_rays;
  AlignedArray<uint32_t> shadow_hits{kBatchCapacity};
  ReflectedRadiance total;             // of all lights
  ReflectedRadiance single;            // of one light, where a layer wants it
  std::vector<Soa3<float>> per_light;  // one for each light layer, per hit
  // Layers on their way to the film.
  AlignedArray<uint32_t> nearest_ray{kBatchCapacity};  // of each pixel, in this round
  Soa3<double> hit_values, ray_values;
  std::vector<HitSpan> spans;
};

// Sets scratch->in_sight for a tile or cell, and readies the scratch for it. False if there is
// nothing to be seen but a background of one colour.
bool EnterTile(const RenderPlan& plan, const Window& tile, TileScratch* scratch);

// Adds up what the batch's hits, sorted into runs, reflect of every light; none is interpolated.
void ShadeHits(const RenderPlan& plan, TileScratch* scratch, StageClock* clock, RenderStats* stats);

// From scratch->samples to its hits and what they reflect.
void TraceAndShade(const RenderPlan& plan, TileScratch* scratch, StageClock* clock,
                   RenderStats* stats);

// Renders the pixels of `tile`, which lies within the strip and has at most kBatchCapacity of them.
// `blank`: 1 if they show nothing but the background already; then whether they do.
void RenderTile(const RenderPlan& plan, const Window& tile, TileScratch* scratch, Strip* strip,
                uint8_t* blank, StageClock* clock, RenderStats* stats);

}  // namespace nacre
