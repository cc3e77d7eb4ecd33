// SPDX-License-Identifier: Apache-2.0
#include "render/samples.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "render/adaptive_plan.h"
#include "sampling/hash.h"

namespace nacre {
namespace {

void ListRows(const Window& tile, std::vector<PixelRun>* runs) {
  for (int y = tile.y0; y < tile.y1; ++y) runs->push_back({tile.x0, y, tile.width()});
}

void ListSpans(const TileCandidates& candidates, std::vector<PixelRun>* runs) {
  const Window& tile = candidates.tile;
  const auto width = static_cast<uint32_t>(tile.width());
  uint32_t row = 0;  // index of the row's first pixel in the tile
  int y = tile.y0;
  for (const PixelSpan& span : candidates.spans) {
    for (; span.first >= row + width; row += width) ++y;
    runs->push_back(
        {tile.x0 + static_cast<int>(span.first - row), y, static_cast<int>(span.count)});
  }
}

// Numbers the sampled pixels, for light sampling.
void NumberPixels(const SamplingPlan& plan, std::span<const PixelRun> runs,
                  SampleNumbers* numbers) {
  numbers->pixel_count = 0;
  for (const PixelRun& run : runs) {
    for (int x = run.x; x < run.x + run.count; ++x) {
      numbers->seeds[numbers->pixel_count++] = PixelSeed(x, run.y, plan.sampler.seed);
    }
  }
  for (int k = 0; k < plan.samples_per_round; ++k) {
    uint32_t* const from = numbers->pixel.data() + static_cast<size_t>(k) * numbers->pixel_count;
    std::iota(from, from + numbers->pixel_count, 0u);
  }
}

// Numbers the samples of a round that begins with sample `first`.
void NumberSamples(int first, int count, SampleNumbers* numbers) {
  for (int k = 0; k < count; ++k) {
    std::fill_n(numbers->number.data() + static_cast<size_t>(k) * numbers->pixel_count,
                numbers->pixel_count, static_cast<uint32_t>(first + k));
  }
}

}  // namespace

SamplingPlan PlanSampling(const Scene& scene, const RenderSettings& settings, PixelSampler sampler,
                          const SamplingNeeds& needs, Explanation* why) {
  SamplingPlan plan;
  plan.sampler = std::move(sampler);
  plan.numbered = needs.sampled_lights;
  const int spp = scene.image.spp;
  // With one sample a pixel, narrow tiles would make small batches.
  plan.tile_width = settings.tile_size > 0 ? std::min(settings.tile_size, kMaxTileWidth)
                                           : (spp == 1 ? kMaxTileWidth : kStripRows);
  plan.samples_per_round =
      std::clamp(static_cast<int>(kBatchCapacity) / (plan.tile_width * kStripRows), 1, spp);
  // With textures a hit takes several times as much memory; smaller batches stay in the cache.
  if (needs.textured) plan.samples_per_round = std::max(plan.samples_per_round / 2, 1);
  if (settings.max_error > 0) {
    why->items.push_back(
        {"sample pattern", true,
         fmt::format("{} independent Owen-scrambled Sobol patterns a pixel", kReplicates)});
  } else {
    why->items.push_back({"sample pattern", spp > 1,
                          spp > 1 ? fmt::format("{} Owen-scrambled Sobol samples a pixel", spp)
                                  : "the only sample of a pixel goes through its centre"});
  }
  plan.every_pixel = needs.every_pixel != nullptr;
  why->items.push_back(
      {"samples beside outlines", plan.every_pixel,
       plan.every_pixel ? needs.every_pixel : "pixels that no sphere reaches show the background"});
  return plan;
}

void SetWeights(const PixelSampler& sampler, int first, int count, CameraSamples* samples) {
  samples->weights.clear();
  for (int i = first; i < first + count; ++i) samples->weights.push_back(SampleWeight(sampler, i));
}

void EnterPixels(const SamplingPlan& plan, const Window& tile, const TileShapes& shapes,
                 CameraSamples* samples) {
  std::vector<PixelRun>& runs = samples->runs;
  runs.clear();
  if (plan.every_pixel || shapes.triangles) {
    ListRows(tile, &runs);
  } else {
    ListSpans(shapes.spheres, &runs);
  }
  samples->film.pixels = CountPixels(runs);
  if (!plan.sampler.centered) PreparePixels(plan.sampler, runs, &samples->pixels);
  if (plan.numbered) NumberPixels(plan, runs, &EnsureNumbers(samples));
}

void MakeSamples(const SamplingPlan& plan, const Window& tile, int first, int count,
                 CameraSamples* samples) {
  FilmBatch& film = samples->film;
  if (plan.sampler.centered) {
    PlaceCenters(tile, film.x.data(), film.y.data());
  } else {
    SamplePixels(plan.sampler, samples->pixels, first, count, film.x.data(), film.y.data());
  }
  film.count = film.pixels * static_cast<size_t>(count);
  SetWeights(plan.sampler, first, count, samples);
  if (plan.numbered) NumberSamples(first, count, &EnsureNumbers(samples));
}

}  // namespace nacre
