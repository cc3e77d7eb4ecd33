// SPDX-License-Identifier: Apache-2.0
// render/tile_work.h: the buffers of one worker, stage by stage, and the way through the stages
// that all samples take.
#pragma once

#include <atomic>

#include "render/direct.h"
#include "render/film.h"
#include "render/film_layers.h"
#include "render/frame_plan.h"
#include "render/hits.h"
#include "render/samples.h"
#include "render/stage_clock.h"
#include "render/surfaces.h"
#include "render/tile_sight.h"

namespace nacre {

// Reused from tile to tile. Each is written by one stage alone, with its room; but ResolveSurfaces
// swaps its buffers with those of `hits`, where it need not copy them.
struct TileWork {
  TileSight sight;        // FindSight
  CameraSamples samples;  // PlaceSamples, or adaptive sampling
  CameraHits hits;        // TraceCamera
  TraceRoom trace_room;
  Surfaces surfaces;  // ResolveSurfaces
  SortRoom sort_room;
  BatchRadiance radiance;  // ShadeDirect
  DirectRoom direct_room;
  TileFilm film;  // AddToFilm
  LayerRoom layer_room;
  const std::atomic<bool>* cancel = nullptr;  // RenderSettings::cancel
};

// From work->samples, whose tile FindSight has seen, to their radiance. Throws Cancelled.
void ShadeSamples(const FramePlan& plan, TileWork* work, StageClock* clock, RenderStats* stats);

// What the film takes of the work.
inline ShadedBatch BatchOf(const FramePlan& plan, const TileWork& work) {
  return {plan.surfaces, work.samples, work.surfaces, work.radiance};
}

// Whether there is anything in the tile but a background of one colour.
inline bool ShowsAnything(const FramePlan& plan, const TileSight& sight) {
  return sight.shapes || plan.film.sky;
}

}  // namespace nacre
