// SPDX-License-Identifier: Apache-2.0
#include "render/tile.h"

#include <algorithm>

namespace nacre {
namespace {

void ShowBackground(const FramePlan& plan, const Window& tile, Strip* strip, uint8_t* blank) {
  if (*blank == 0) FillBackground(plan.film, tile, strip);
  *blank = 1;
}

// The only sample of each pixel.
void RenderOnce(const FramePlan& plan, const Window& tile, TileWork* work, Strip* strip,
                uint8_t* blank, StageClock* clock, RenderStats* stats) {
  PlaceSamples(plan.sampling, tile, work->sight, 0, 1, &work->samples);
  ShadeSamples(plan, work, clock, stats);
  const ShadedBatch batch = BatchOf(plan, *work);
  if (batch.hits().count == 0) {
    ShowBackground(plan, tile, strip, blank);
  } else {
    *blank = 0;
    if (!PutOnlySamples(plan.film, batch, tile, &work->layer_room, strip)) {
      StartTile(plan.film, tile, &work->film);
      AddToFilm(plan.film, batch, &work->layer_room, &work->film);
      ResolveTile(plan.film, work->film, strip);
    }
  }
  clock->Charge(Stage::kFilm);
}

}  // namespace

void RenderTile(const FramePlan& plan, const Window& tile, TileWork* work, Strip* strip,
                uint8_t* blank, StageClock* clock, RenderStats* stats) {
  FindSight(plan.hits, tile, &work->sight);
  clock->Charge(Stage::kIntersect);
  if (!ShowsAnything(plan, work->sight) && HasUnitWeights(plan.sampling.sampler)) {
    ShowBackground(plan, tile, strip, blank);
    clock->Charge(Stage::kFilm);
    return;
  }
  ChoosePlaces(plan.sampling, tile, work->sight, &work->samples);
  if (plan.film.one_sample) return RenderOnce(plan, tile, work, strip, blank, clock, stats);
  *blank = 0;
  clock->Charge(Stage::kSample);
  StartTile(plan.film, tile, &work->film);
  clock->Charge(Stage::kFilm);
  const int spp = plan.film.spp;
  for (int first = 0; first < spp; first += plan.sampling.samples_per_round) {
    const int count = std::min(plan.sampling.samples_per_round, spp - first);
    PlaceSamples(plan.sampling, tile, work->sight, first, count, &work->samples);
    ShadeSamples(plan, work, clock, stats);
    AddToFilm(plan.film, BatchOf(plan, *work), &work->layer_room, &work->film);
    clock->Charge(Stage::kFilm);
  }
  ResolveTile(plan.film, work->film, strip);
  clock->Charge(Stage::kFilm);
}

}  // namespace nacre
