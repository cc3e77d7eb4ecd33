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
      StartTile(plan.film, tile, kBatchCapacity, &work->film);
      AddToFilm(plan.film, batch, &work->layer_room, &work->film);
      ResolveTile(plan.film, work->film, strip);
    }
  }
  clock->Charge(Stage::kFilm);
}

// Of a tile whose places have been chosen.
void AddRounds(const FramePlan& plan, const Window& tile, int first, int end, TileWork* work,
               TileFilm* film, StageClock* clock, RenderStats* stats) {
  const int most = plan.sampling.samples_per_round;
  for (; first < end; first += most) {
    PlaceSamples(plan.sampling, tile, work->sight, first, std::min(most, end - first),
                 &work->samples);
    ShadeSamples(plan, work, clock, stats);
    AddToFilm(plan.film, BatchOf(plan, *work), &work->layer_room, film);
    clock->Charge(Stage::kFilm);
  }
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
  StartTile(plan.film, tile, kBatchCapacity, &work->film);
  clock->Charge(Stage::kFilm);
  AddRounds(plan, tile, 0, plan.film.spp, work, &work->film, clock, stats);
  ResolveTile(plan.film, work->film, strip);
  clock->Charge(Stage::kFilm);
}

void AddSamples(const FramePlan& plan, const Window& tile, int first, int end, TileWork* work,
                TileFilm* film, StageClock* clock, RenderStats* stats) {
  FindSight(plan.hits, tile, &work->sight);
  clock->Charge(Stage::kIntersect);
  if (!ShowsAnything(plan, work->sight)) return;  // the film is of hits alone
  ChoosePlaces(plan.sampling, tile, work->sight, &work->samples);
  clock->Charge(Stage::kSample);
  AddRounds(plan, tile, first, end, work, film, clock, stats);
}

}  // namespace nacre
