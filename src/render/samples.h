// SPDX-License-Identifier: Apache-2.0
// render/samples.h: the first stage: where camera samples lie on the film, what they weigh, and
// their places in the random sequences of their pixels.
#pragma once

#include <optional>
#include <vector>

#include "base/image.h"
#include "base/strip.h"
#include "hit/batch.h"
#include "render/explanation.h"
#include "render/settings.h"
#include "render/tile_sight.h"
#include "sampling/pair_sampler.h"
#include "sampling/pixel_sampler.h"
#include "scene/scene.h"

namespace nacre {

// Columns of a tile: where it spans more cells, less of what it gathers stays in L1.
inline constexpr int kWidestTile = 64;
static_assert(kWidestTile * kStripRows <= static_cast<int>(kBatchCapacity));

struct SamplingPlan {
  PixelSampler sampler;
  int tile_width = 16;        // pixels; tiles are as high as strips
  int samples_per_round = 1;  // samples of a tile's pixels that make one batch
  // Pixels beside all spheres get no places: that their samples hit nothing is all that is asked.
  bool skip_empty_pixels = false;
  bool numbered = false;  // lights are sampled: CameraSamples::numbers is filled
};

// What decides how a frame is sampled besides the scene.
struct SamplingNeeds {
  bool sampled_lights;
  bool textured;
  const char* places;  // why every sample needs its place on the film, or null
};

SamplingPlan PlanSampling(const Scene& scene, const RenderSettings& settings, PixelSampler sampler,
                          const SamplingNeeds& needs, Explanation* why);

// One batch of camera samples.
struct CameraSamples {
  FilmBatch film;
  std::vector<double> weights;           // of a pixel's samples in this batch
  std::optional<SampleNumbers> numbers;  // made for the first batch under sampled lights
  // Room: pixels whose samples are placed.
  std::vector<PixelRun> runs;
  PixelBatch pixels{kBatchCapacity};
};

// The numbers, made if they are not there.
inline SampleNumbers& NumbersOf(CameraSamples* samples) {
  if (!samples->numbers) samples->numbers.emplace(kBatchCapacity);
  return *samples->numbers;
}

// Readies the samples for a tile that FindSight has seen: which of its pixels get places.
void ChoosePlaces(const SamplingPlan& plan, const Window& tile, const TileSight& sight,
                  CameraSamples* samples);

// Samples [first, first + count) of each of the tile's pixels, sample by sample, row by row.
void PlaceSamples(const SamplingPlan& plan, const Window& tile, const TileSight& sight, int first,
                  int count, CameraSamples* samples);

}  // namespace nacre
