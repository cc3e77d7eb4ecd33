// SPDX-License-Identifier: Apache-2.0
#include "render/tile_work.h"

namespace nacre {

void ShadeSamples(const FramePlan& plan, TileWork* work) {
  TileWork& w = *work;
  ThrowIfCancelled(w.cancel);
  const FilmBatch& film = w.samples.film;
  w.stats->camera_rays += film.count;
  w.clock->Charge(Stage::kSample);
  TraceCamera(plan.hits, w.shapes, film, &w.trace_room, &w.hits);
  if (w.shapes.any) w.clock->Charge(Stage::kIntersect);
  const size_t hits = w.hits.batch.count;
  w.stats->hits += hits;
  ResolveSurfaces(plan.surfaces, film.x.data(), &w.hits, &w.sort_room, &w.surfaces);
  if (hits > 0) {
    w.clock->Charge(Stage::kSurfaces);
    ShadeDirect({plan.direct, w.surfaces, w.direct_room, w.radiance, *w.clock, *w.stats},
                w.samples.numbers ? &*w.samples.numbers : nullptr);
    if (w.surfaces.lit < hits) {
      InterpolateRadiance(plan.hits.shapes, plan.meshes.radiance, w.surfaces, &w.radiance);
      w.clock->Charge(Stage::kShade);
    }
  }
  ShadeSky(plan.direct, film, hits, &w.direct_room, &w.radiance);
}

}  // namespace nacre
