// SPDX-License-Identifier: Apache-2.0
// render/film.h: the last stage: sums of samples of a tile's pixels, and the finished strip that
// they are averaged into.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/aligned.h"
#include "base/image.h"
#include "hit/camera_frame.h"
#include "render/explanation.h"
#include "render/film_kernel.h"
#include "render/lights_plan.h"
#include "render/output_layers.h"
#include "render/settings.h"
#include "sampling/pixel_sampler.h"

namespace nacre {

struct PlannedChannel {
  ChannelKind kind;
  double background;  // BackgroundOf
};

struct FilmPlan {
  std::vector<Layer> layers;             // beauty, alpha, then those of the settings
  std::vector<PlannedChannel> channels;  // of the layers, in their order
  CameraFrame camera{};
  int spp = 1;
  double weight = 1;        // sum of the weights of a pixel's samples
  Rgb background{0, 0, 0};  // where nothing is hit, unless `sky`
  bool sky = false;         // the background is BatchRadiance::sky
  bool one_sample = false;  // the only sample of a pixel is its value: there are no sums
};

// Returns FilmPlan::layers, which other stages' plans depend on, too. Throws Error (usage) for a
// layer that the scene does not have.
std::vector<Layer> PlanLayers(const Scene& scene, const RenderSettings& settings, Explanation* why);

FilmPlan PlanFilm(const Scene& scene, const RenderSettings& settings, std::vector<Layer> layers,
                  const CameraFrame& camera, const LightsPlan& lights, const PixelSampler& sampler,
                  Explanation* why);

// The sampled pixels of a tile, one array per channel, row by row. Averaged channels are summed in
// double and rounded to float once, however many samples there are and however their weights
// cancel, so that the layers add up to the beauty. Uniform sampling sums only hits: the sum of the
// alpha layer is their weight, and the remaining weight shows the background. Adaptive sampling
// also sums the values of misses.
struct TileFilm {
  Window window;
  // The sampled pixels, in the order of the sums. All others of the window show the background.
  std::vector<PixelRun> runs;
  std::vector<AlignedArray<double>> sums;    // averaged channels, in layer order
  std::vector<AlignedArray<float>> nearest;  // P and Z channels, in layer order
  std::vector<AlignedArray<uint32_t>> ids;   // id channels, in layer order
  AlignedArray<double> nearest_distance2;    // of their sample from the centre, in pixels^2
};

// The index in TileFilm::sums of the alpha layer, which follows the three channels of the beauty.
inline constexpr size_t kAlphaSum = 3;

// A finished strip, channels in the order of StripChannels, row by row. Id channels hold uint32_t.
struct Strip {
  Window window;
  std::vector<std::span<float>> colors;  // all float channels, in order
  std::vector<std::span<uint32_t>> ids;  // all uint channels, in order
  // The memory of the channels, except for colours that are stored in an image.
  std::vector<AlignedArray<float>> color_buffers;
  std::vector<AlignedArray<uint32_t>> id_buffers;
};

// The rows of a tile in a channel of the strip that holds it.
template <typename T>
PixelRows<T> RowsIn(const Window& strip, const Window& tile, std::span<T> channel) {
  const auto stride = static_cast<size_t>(strip.width());
  return {channel.data() + static_cast<size_t>(tile.y0 - strip.y0) * stride +
              static_cast<size_t>(tile.x0 - strip.x0),
          static_cast<size_t>(tile.width()), static_cast<size_t>(tile.height()), stride};
}

// The channels of a strip and of the files written from it: float channels first, then ids.
std::vector<ChannelSpec> StripChannels(const std::vector<Layer>& layers, PixelType color_type);

// Gives the strip the plan's channels. If `image` is not null, it must have the plan's channels,
// and its rows become the strip's colours. Otherwise the pixels of the strip's buffers stay if
// these were large enough: RenderTile's `blank` relies on it.
void StartStrip(const FilmPlan& plan, const Window& window, Image* image, Strip* strip);

// Whether some layers hold the value of one sample, not an average.
bool ShowsNearest(const std::vector<Layer>& layers);

// Clears the channels of a tile. `capacity` is the largest number of pixels of any tile that this
// film is used for, at most kBatchCapacity.
void StartTile(const FilmPlan& plan, const Window& tile, size_t capacity, TileFilm* film);

// The value of a layer where nothing is hit, representable in float. 0 if it is the sky's.
Rgb BackgroundOf(const Layer& layer, const FilmPlan& plan);

// Whether the layer shows the background.
bool ShowsBackground(const Layer& layer);

// Layers are stored as float. The beauty is computed from the rounded values, so that it is exactly
// their sum.
Rgb RoundToFloat(const Rgb& value);

// Fills a tile in which nothing is hit with the bits that its film would give.
void FillBackground(const FilmPlan& plan, const Window& tile, Strip* strip);

// Adds the background to the sums, divides by the number of samples, rounds to float and writes the
// tile to its strip.
void ResolveTile(const FilmPlan& plan, const TileFilm& film, Strip* strip);

}  // namespace nacre
