// SPDX-License-Identifier: Apache-2.0
// render/film_layers.h: from the radiance of a batch of hits to the film's layers.
#pragma once

#include <algorithm>
#include <vector>

#include "render/direct_batch.h"
#include "render/film.h"
#include "render/samples.h"
#include "render/surfaces.h"

namespace nacre {

// A batch that has been through all stages but the film.
struct ShadedBatch {
  const SurfacePlan& plan;
  const CameraSamples& samples;
  const Surfaces& surfaces;
  const BatchRadiance& radiance;

  const HitBatch& hits() const { return surfaces.hits; }
};

// Buffers for layers on their way to the film.
struct LayerRoom {
  Soa3<double> hit_values, ray_values;
  std::vector<HitSpan> spans;
  AlignedArray<uint32_t> nearest_ray{kBatchCapacity};  // of each pixel, in this batch
};

inline AlignedArray<double>& ChannelOf(Soa3<double>& soa, int c) {
  return c == 0 ? soa.x : c == 1 ? soa.y : soa.z;
}

// An averaged layer's values at the rays of the batch, in buffers of the room; `background` for
// those that hit nothing.
Soa3<double>& GatherLayer(const FilmPlan& plan, const Layer& layer, size_t light_layer,
                          const Rgb& background, const ShadedBatch& batch, LayerRoom* room);

// Takes P, Z and ids of the film's entry `pixel` from a hit.
void PutNearest(const FilmPlan& plan, const ShadedBatch& batch, size_t hit, size_t pixel,
                TileFilm* film);

// A pixel: its entry in the film, and its place in the frame.
struct FilmPixel {
  size_t index;
  int x, y;
};

// Takes P, Z and ids, where layers ask for them, from the hit nearest to its pixel's centre, and of
// several as near, which may be in different runs, from that of the first ray of a batch.
// pixel_of(ray) is a FilmPixel.
template <class PixelOf>
void AddNearest(const FilmPlan& plan, const ShadedBatch& batch, const PixelOf& pixel_of,
                LayerRoom* room, TileFilm* film) {
  if (batch.hits().count == 0 || film->nearest_distance.size() == 0) return;
  constexpr uint32_t kNone = 0xffffffffu;
  std::fill_n(room->nearest_ray.data(), kBatchCapacity, kNone);
  const FilmBatch& samples = batch.samples.film;
  for (size_t i = 0; i < batch.hits().count; ++i) {
    const uint32_t ray = batch.hits().ray[i];
    const FilmPixel pixel = pixel_of(ray);
    const double dx = samples.x[ray] - (pixel.x + 0.5);
    const double dy = samples.y[ray] - (pixel.y + 0.5);
    const double distance = dx * dx + dy * dy;
    double& nearest = film->nearest_distance[pixel.index];
    uint32_t& nearest_ray = room->nearest_ray[pixel.index];
    const bool earlier = distance == nearest && nearest_ray != kNone && ray < nearest_ray;
    if (!(distance < nearest || earlier)) continue;
    nearest = distance;
    nearest_ray = ray;
    PutNearest(plan, batch, i, pixel.index, film);
  }
}

// Adds a tile's round of samples to every layer of its film.
void AddToFilm(const FilmPlan& plan, const ShadedBatch& batch, LayerRoom* room, TileFilm* film);

// Puts a round into the strip that is all of the samples of its tile's pixels (FilmPlan::
// one_sample), without sums: the same bits. False, and nothing is put, if it takes more than that.
bool PutOnlySamples(const FilmPlan& plan, const ShadedBatch& batch, const Window& tile,
                    LayerRoom* room, Strip* strip);

// Fills a tile that nothing is hit in, under samples of weight 1, with what its film would resolve
// to: to the bit, because the background is a float and sums of it are exact.
void FillBackground(const FilmPlan& plan, const Window& tile, Strip* strip);

}  // namespace nacre
