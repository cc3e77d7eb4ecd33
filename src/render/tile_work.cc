// SPDX-License-Identifier: Apache-2.0
#include "render/tile_work.h"

namespace nacre {

void ShadeSamples(const FramePlan& plan, TileWork* work, StageClock* clock, RenderStats* stats) {
  TileWork& w = *work;
  ThrowIfCancelled(w.cancel);
  const FilmBatch& film = w.samples.film;
  stats->camera_rays += film.count;
  clock->Charge(Stage::kSample);
  TraceCamera(plan.hits, w.shapes, film, &w.trace_room, &w.hits);
  if (w.shapes.any) clock->Charge(Stage::kIntersect);
  const size_t hits = w.hits.batch.count;
  stats->hits += hits;
  ResolveSurfaces(plan.surfaces, film.x.data(), &w.hits, &w.sort_room, &w.surfaces);
  if (hits > 0) {
    clock->Charge(Stage::kSurfaces);
    ShadeDirect({plan.direct, w.surfaces, w.direct_room, w.radiance, *clock, *stats},
                w.samples.numbers ? &*w.samples.numbers : nullptr);
    if (w.surfaces.lit < hits) {
      InterpolateRadiance(plan.hits.shapes, plan.meshes.radiance, w.surfaces, &w.radiance);
      clock->Charge(Stage::kShade);
    }
  }
  ShadeSky(plan.direct, film, hits, &w.direct_room, &w.radiance);
}

}  // namespace nacre
