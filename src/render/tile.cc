// SPDX-License-Identifier: Apache-2.0
#include "render/tile.h"

#include <algorithm>

namespace nacre {
namespace {

void ShowBackground(const FramePlan& plan, const Window& tile, Strip* strip, uint8_t* blank) {
  if (*blank == 0) FillBackground(plan.film, tile, strip);
  *blank = 1;
}

// Renders a tile if FilmPlan::one_sample.
void RenderOnce(const FramePlan& plan, const Window& tile, TileWork* work, Strip* strip,
                uint8_t* blank) {
  MakeSamples(plan.sampling, tile, 0, 1, &work->samples);
  ShadeSamples(plan, work);
  const ShadedBatch batch = BatchOf(plan, *work);
  if (batch.hits().count == 0) {
    ShowBackground(plan, tile, strip, blank);
  } else {
    *blank = 0;
    if (!StoreOnlySamples(plan.film, batch, tile, &work->layer_room, strip)) {
      StartTile(plan.film, tile, kBatchCapacity, &work->film);
      work->film.runs = work->samples.runs;
      AddToFilm(plan.film, batch, &work->layer_room, &work->film);
      ResolveTile(plan.film, work->film, strip);
    }
  }
  work->clock->Charge(Stage::kFilm);
}

// Adds the samples of the pixels that EnterPixels has chosen, in rounds.
void AddRounds(const FramePlan& plan, const Window& tile, int first, int end, TileWork* work,
               TileFilm* film) {
  const int per_round = plan.sampling.samples_per_round;
  film->runs = work->samples.runs;
  for (; first < end; first += per_round) {
    MakeSamples(plan.sampling, tile, first, std::min(per_round, end - first), &work->samples);
    ShadeSamples(plan, work);
    AddToFilm(plan.film, BatchOf(plan, *work), &work->layer_room, film);
    work->clock->Charge(Stage::kFilm);
  }
}

// Finds the shapes that the tile's rays may hit. Returns false if the tile shows nothing but a
// background of one colour.
bool EnterTile(const FramePlan& plan, const Window& tile, TileWork* work) {
  FindTileShapes(plan.hits, tile, &work->shapes);
  work->clock->Charge(Stage::kIntersect);
  return ShowsAnything(plan, work->shapes);
}

}  // namespace

void RenderTile(const FramePlan& plan, const Window& tile, TileWork* work, Strip* strip,
                uint8_t* blank) {
  if (!EnterTile(plan, tile, work)) {
    ShowBackground(plan, tile, strip, blank);
    work->clock->Charge(Stage::kFilm);
    return;
  }
  EnterPixels(plan.sampling, tile, work->shapes, &work->samples);
  if (plan.film.one_sample) return RenderOnce(plan, tile, work, strip, blank);
  *blank = 0;
  work->clock->Charge(Stage::kSample);
  StartTile(plan.film, tile, kBatchCapacity, &work->film);
  work->clock->Charge(Stage::kFilm);
  AddRounds(plan, tile, 0, plan.film.spp, work, &work->film);
  ResolveTile(plan.film, work->film, strip);
  work->clock->Charge(Stage::kFilm);
}

void AddTileSamples(const FramePlan& plan, const Window& tile, int first, int end, TileWork* work,
                    TileFilm* film) {
  // Films are sums over hits, so a tile without any has nothing to add.
  if (!EnterTile(plan, tile, work)) return;
  EnterPixels(plan.sampling, tile, work->shapes, &work->samples);
  work->clock->Charge(Stage::kSample);
  AddRounds(plan, tile, first, end, work, film);
}

}  // namespace nacre
