// SPDX-License-Identifier: Apache-2.0
// render/samples.h: the first stage: the positions of camera samples on the film, their weights,
// and their numbers in the random sequences of their pixels.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/image.h"
#include "base/strip.h"
#include "hit/batch.h"
#include "render/explanation.h"
#include "render/settings.h"
#include "render/tile_shapes.h"
#include "sampling/pair_sampler.h"
#include "sampling/pixel_sampler.h"
#include "scene/scene.h"

namespace nacre {

// Wider tiles overlap more cells, and the spheres that they gather no longer fit into L1.
inline constexpr int kMaxTileWidth = 64;
static_assert(kMaxTileWidth * kStripRows <= static_cast<int>(kBatchCapacity));

struct SamplingPlan {
  PixelSampler sampler;
  int tile_width = 16;        // in pixels; tiles are as high as strips
  int samples_per_round = 1;  // samples of each of a tile's pixels in one batch
  bool every_pixel = true;    // also the pixels in which no ray hits anything
  bool numbered = false;      // lights are sampled: CameraSamples::numbers is filled
};

// What other stages require of samples.
struct SamplingNeeds {
  bool sampled_lights;
  bool textured;
  const char* every_pixel;  // why pixels in which no ray hits anything are sampled; or null
};

SamplingPlan PlanSampling(const Scene& scene, const RenderSettings& settings, PixelSampler sampler,
                          const SamplingNeeds& needs, Explanation* why);

// One batch of camera samples.
struct CameraSamples {
  FilmBatch film;
  std::vector<double> weights;           // by sample of a pixel
  std::optional<SampleNumbers> numbers;  // made for the first batch if lights are sampled
  std::vector<PixelRun> runs;            // the sampled pixels of a tile, row by row
  PixelBatch pixels{kBatchCapacity};     // these pixels, prepared; not for centred samplers
};

// Returns the numbers, which are made if there are none yet.
inline SampleNumbers& EnsureNumbers(CameraSamples* samples) {
  if (!samples->numbers) samples->numbers.emplace(kBatchCapacity);
  return *samples->numbers;
}

// Sets the weights to those of samples [first, first + count) of a pixel.
void SetWeights(const PixelSampler& sampler, int first, int count, CameraSamples* samples);

// Numbers samples [first, first + count) of each of `pixels` pixels, pixel by pixel. Pixel i has
// the seed seed_of(i).
template <class SeedOf>
void NumberPixelByPixel(size_t pixels, int first, size_t count, const SeedOf& seed_of,
                        SampleNumbers* numbers) {
  numbers->pixel_count = pixels;
  size_t ray = 0;
  for (uint32_t i = 0; i < pixels; ++i) {
    numbers->seeds[i] = seed_of(i);
    for (uint32_t k = 0; k < count; ++k, ++ray) {
      numbers->number[ray] = static_cast<uint32_t>(first) + k;
      numbers->pixel[ray] = i;
    }
  }
}

// Chooses the pixels of a tile that are sampled, before its first round: all of them, or those
// whose rays may hit something. `shapes` comes from FindTileShapes.
void EnterPixels(const SamplingPlan& plan, const Window& tile, const TileShapes& shapes,
                 CameraSamples* samples);

// Makes samples [first, first + count) of each of these pixels, ordered by sample, then by row.
void MakeSamples(const SamplingPlan& plan, const Window& tile, int first, int count,
                 CameraSamples* samples);

}  // namespace nacre
