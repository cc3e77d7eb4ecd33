// SPDX-License-Identifier: Apache-2.0
// render/film_layers.h: writes the radiance of a batch of hits to the layers of the film.
#pragma once

#include <algorithm>
#include <vector>

#include "render/direct_batch.h"
#include "render/film.h"
#include "render/samples.h"
#include "render/surfaces.h"

namespace nacre {

// A batch that has passed all stages except the film.
struct ShadedBatch {
  const SurfacePlan& plan;
  const CameraSamples& samples;
  const Surfaces& surfaces;
  const BatchRadiance& radiance;

  const HitBatch& hits() const { return surfaces.hits; }
};

// Buffers of this stage.
struct LayerRoom {
  Soa3<double> hit_values, ray_values;
  std::vector<HitSpan> spans;
  AlignedArray<uint32_t> nearest_ray{kBatchCapacity};  // by pixel, of the rays of one batch
};

// Returns the values of an averaged layer by ray of the batch, in a buffer of the room. Rays that
// hit nothing have the value `background`, or the radiance of the sky.
Soa3<double>& GatherLayer(const FilmPlan& plan, const Layer& layer, const Rgb& background,
                          const ShadedBatch& batch, LayerRoom* room);

// Sets P, Z and ids of the film's entry `pixel` to those of a hit.
void StoreNearest(const FilmPlan& plan, const ShadedBatch& batch, size_t hit, size_t pixel,
                  TileFilm* film);

// A pixel: its index in the film, and its position in the frame.
struct FilmPixel {
  size_t index;
  int x, y;
};

// Sets P, Z and ids, if there are layers of them, to those of the hit nearest to the pixel's
// centre. Of several hits of a batch at the same distance, which may be in different runs, the one
// with the first ray counts. pixel_of(ray) is a FilmPixel.
template <class PixelOf>
void AddNearest(const FilmPlan& plan, const ShadedBatch& batch, const PixelOf& pixel_of,
                LayerRoom* room, TileFilm* film) {
  if (batch.hits().count == 0 || film->nearest_distance2.size() == 0) return;
  constexpr uint32_t kNone = 0xffffffffu;
  std::fill_n(room->nearest_ray.data(), kBatchCapacity, kNone);
  const FilmBatch& samples = batch.samples.film;
  for (size_t i = 0; i < batch.hits().count; ++i) {
    const uint32_t ray = batch.hits().ray[i];
    const FilmPixel pixel = pixel_of(ray);
    const double dx = samples.x[ray] - (pixel.x + 0.5);
    const double dy = samples.y[ray] - (pixel.y + 0.5);
    const double distance = dx * dx + dy * dy;
    double& nearest = film->nearest_distance2[pixel.index];
    uint32_t& nearest_ray = room->nearest_ray[pixel.index];
    const bool earlier = distance == nearest && nearest_ray != kNone && ray < nearest_ray;
    if (!(distance < nearest || earlier)) continue;
    nearest = distance;
    nearest_ray = ray;
    StoreNearest(plan, batch, i, pixel.index, film);
  }
}

// Adds a tile's round of samples to every layer of its film.
void AddToFilm(const FilmPlan& plan, const ShadedBatch& batch, LayerRoom* room, TileFilm* film);

// For FilmPlan::one_sample: writes the only round of a tile directly to the strip, with the bits
// that sums would give. Returns false, and writes nothing, if materials are mapped.
bool StoreOnlySamples(const FilmPlan& plan, const ShadedBatch& batch, const Window& tile,
                      LayerRoom* room, Strip* strip);

}  // namespace nacre
