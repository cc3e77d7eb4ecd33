// SPDX-License-Identifier: Apache-2.0
// render/film.h: the last stage: a tile of the picture while its samples come in, and the strip it
// ends in.
#pragma once

#include <cstdint>
#include <vector>

#include "base/aligned.h"
#include "base/image.h"
#include "hit/camera_frame.h"
#include "render/explanation.h"
#include "render/film_kernel.h"
#include "render/layers.h"
#include "render/settings.h"
#include "sampling/pixel_sampler.h"

namespace nacre {

struct FilmPlan {
  std::vector<Layer> layers;          // beauty, alpha, then those asked for
  std::vector<ChannelKind> channels;  // of the layers, in their order
  CameraFrame camera{};
  int spp = 1;
  double weight = 1;        // of all samples of a pixel
  Rgb background{0, 0, 0};  // seen where nothing is hit, if not `sky`
  bool sky = false;         // the background is BatchRadiance::sky
  // The beauty is what the only light's kernel makes of the parts: BatchRadiance::total.sum.
  bool beauty_is_sum = false;
  bool one_sample = false;  // a pixel's only sample is its value: no sums
};

// The layers, which other stages' plans depend on. Throws Error (usage) for one that the scene does
// not have.
void PlanLayers(const Scene& scene, const RenderSettings& settings, FilmPlan* plan,
                Explanation* why);

// Then whether samples are added up; all else of the plan is there.
void PlanSums(const Scene& scene, const RenderSettings& settings, const PixelSampler& sampler,
              FilmPlan* plan, Explanation* why);

// The tile's pixels, one plane per channel, row by row. Averaged channels are summed in double:
// every layer rounds once, however many samples there are and however their weights cancel, and
// so the layers add up to the beauty. The sums are of hits alone: those of the alpha layer, the
// hits' weights, tell how much of the background the rest shows.
struct TileFilm {
  Window window;
  std::vector<AlignedArray<double>> sums;    // averaged channels, in layer order
  std::vector<AlignedArray<float>> nearest;  // P and Z channels, in layer order
  std::vector<AlignedArray<uint32_t>> ids;   // id channels, in layer order
  AlignedArray<double> nearest_distance;     // of the sample they come from, pixels squared
};

// Which of a film's sums are those of the alpha layer: it follows the beauty.
inline constexpr size_t kAlphaSum = 3;

// A finished strip, channels in the order of StripChannels. Id channels hold uint32_t.
struct Strip {
  Window window;
  // Row by row; the arrays may be larger than the window.
  std::vector<AlignedArray<float>> colors;  // all float channels, in order
  std::vector<AlignedArray<uint32_t>> ids;  // all uint channels, in order
};

// The rows of a tile in a channel of the strip that it lies in.
template <typename T>
PixelRows<T> RowsIn(const Window& strip, const Window& tile, AlignedArray<T>* channel) {
  const auto stride = static_cast<size_t>(strip.width());
  return {channel->data() + static_cast<size_t>(tile.y0 - strip.y0) * stride +
              static_cast<size_t>(tile.x0 - strip.x0),
          static_cast<size_t>(tile.width()), static_cast<size_t>(tile.height()), stride};
}

// The channels of a strip's files: float channels first, then ids.
std::vector<ChannelSpec> StripChannels(const std::vector<Layer>& layers, PixelType color_type);

// Gives the strip the plan's channels with room for the window. Pixels that were there stay where
// the room suffices: RenderStrip counts on it.
void StartStrip(const FilmPlan& plan, const Window& window, Strip* strip);

// Whether some layers show one sample of a pixel, not an average.
bool ShowsNearest(const FilmPlan& plan);

// Empties the tile's channels. `room`: the most pixels that tiles of this film have, at most
// kBatchCapacity.
void StartTile(const FilmPlan& plan, const Window& tile, size_t room, TileFilm* film);

// What a layer shows where nothing is hit: a colour of floats.
Rgb BackgroundOf(const Layer& layer, const FilmPlan& plan);

// Whether what lies behind the shapes shows in the layer.
bool ShowsBackground(const Layer& layer);

// Layers hold floats; what they add up to is computed from the same floats.
Rgb RoundToFloat(const Rgb& value);

// Adds the background, divides by the number of samples, rounds to float and puts the tile into its
// strip.
void ResolveTile(const FilmPlan& plan, const TileFilm& film, Strip* strip);

}  // namespace nacre
