// SPDX-License-Identifier: Apache-2.0
// render/tile_layers.h: from the radiance of a batch of hits to the film's layers.
#pragma once

#include <algorithm>

#include "render/tile.h"

namespace nacre {

// Adds scratch->single, the reflection of one light, to the total and, unless -1, to a light layer.
void KeepLight(int light_layer, TileScratch* scratch);

// Adds what a light leaves to its layer alone.
void ShowLight(const ReflectedRadiance& of_light, int light_layer, TileScratch* scratch);

inline AlignedArray<double>& ChannelOf(Soa3<double>& soa, int c) {
  return c == 0 ? soa.x : c == 1 ? soa.y : soa.z;
}

// An averaged layer's values at the rays of scratch->samples, in buffers of the scratch;
// `background` for those that hit nothing.
Soa3<double>& GatherLayer(const RenderPlan& plan, const Layer& layer, size_t light_layer,
                          const Rgb& background, TileScratch* scratch);

// Finds what of the plan's sky, if it has one, the samples' rays see that hit nothing, for
// GatherLayer.
void SeeSky(const RenderPlan& plan, TileScratch* scratch);

// Takes P, Z and ids of the film's entry `pixel` from a hit.
void PutNearest(const RenderPlan& plan, size_t hit, size_t pixel, TileScratch* scratch);

// A pixel: its entry in the film, and its place in the frame.
struct FilmPixel {
  size_t index;
  int x, y;
};

// Takes P, Z and ids from the hit nearest to its pixel's centre, and of several as near, which may
// be in different runs, from that of the first ray of a round. pixel_of(ray) is a FilmPixel.
template <class PixelOf>
void AddNearest(const RenderPlan& plan, const PixelOf& pixel_of, TileScratch* scratch) {
  TileScratch& s = *scratch;
  constexpr uint32_t kNone = 0xffffffffu;
  std::fill_n(s.nearest_ray.data(), kBatchCapacity, kNone);
  for (size_t i = 0; i < s.hits.count; ++i) {
    const uint32_t ray = s.hits.ray[i];
    const FilmPixel pixel = pixel_of(ray);
    const double dx = s.samples.x[ray] - (pixel.x + 0.5);
    const double dy = s.samples.y[ray] - (pixel.y + 0.5);
    const double distance = dx * dx + dy * dy;
    double& nearest = s.film.nearest_distance[pixel.index];
    uint32_t& nearest_ray = s.nearest_ray[pixel.index];
    const bool earlier = distance == nearest && nearest_ray != kNone && ray < nearest_ray;
    if (!(distance < nearest || earlier)) continue;
    nearest = distance;
    nearest_ray = ray;
    PutNearest(plan, i, pixel.index, &s);
  }
}

// Adds a round's samples to every layer of the tile's film.
void AddToFilm(const RenderPlan& plan, TileScratch* scratch);

// Puts a round into the strip that is all of the samples of its tile's pixels (RenderPlan::
// one_sample), without sums: the same bits. False, and nothing is put, if it takes more than that.
bool PutOnlySamples(const RenderPlan& plan, TileScratch* scratch, Strip* strip);

// Fills a tile that nothing is hit in, under samples of weight 1, with what its film would resolve
// to: to the bit, because the background is a float and sums of it are exact.
void FillBackground(const RenderPlan& plan, const Window& tile, Strip* strip);

}  // namespace nacre
