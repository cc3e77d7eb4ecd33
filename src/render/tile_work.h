// SPDX-License-Identifier: Apache-2.0
// render/tile_work.h: the buffers of one worker, stage by stage, and the stages that all samples
// pass through.
#pragma once

#include <atomic>

#include "render/direct.h"
#include "render/film.h"
#include "render/film_layers.h"
#include "render/frame_plan.h"
#include "render/hits.h"
#include "render/samples.h"
#include "render/stats.h"
#include "render/surfaces.h"
#include "render/tile_shapes.h"

namespace nacre {

// Reused from tile to tile. Each result and its buffers are written by only one stage, which a
// comment names together with the function that does most of the work; but ResolveSurfaces swaps
// its buffers with those of `hits` where it need not sort.
struct TileWork {
  TileShapes shapes;      // FindTileShapes
  CameraSamples samples;  // samples: EnterPixels, MakeSamples; or adaptive sampling
  CameraHits hits;        // hits: TraceCamera
  TraceRoom trace_room;
  Surfaces surfaces;  // surfaces: ResolveSurfaces
  SortRoom sort_room;
  BatchRadiance radiance;  // radiance: ShadeDirect, or ShadeSky where rays hit nothing
  DirectRoom direct_room;
  TileFilm film;  // film: StartTile, AddToFilm; or adaptive sampling
  LayerRoom layer_room;
  const std::atomic<bool>* cancel = nullptr;  // RenderSettings::cancel
  StageClock* clock = nullptr;                // of the strip that is rendered, as is `stats`
  RenderStats* stats = nullptr;
};

// Traces and shades work->samples, which belong to a tile whose shapes are in work->shapes: fills
// `hits`, `surfaces` and `radiance`. Throws Cancelled.
void ShadeSamples(const FramePlan& plan, TileWork* work);

// What the film reads of the work.
inline ShadedBatch BatchOf(const FramePlan& plan, const TileWork& work) {
  return {plan.surfaces, work.samples, work.surfaces, work.radiance};
}

// Whether the tile may show anything but a background of one colour.
inline bool ShowsAnything(const FramePlan& plan, const TileShapes& shapes) {
  return shapes.any || plan.film.sky;
}

}  // namespace nacre
