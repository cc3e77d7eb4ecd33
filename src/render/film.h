// render/film.h: a tile of the picture while its samples come in, and the strip it ends in.
#pragma once

#include <cstdint>
#include <vector>

#include "base/aligned.h"
#include "base/image.h"
#include "render/plan.h"

namespace nacre {

// The tile's pixels, one plane per channel, row by row. Averaged channels are summed in double:
// every layer rounds once, however many samples there are and however their weights cancel, and
// so the layers add up to the beauty.
struct TileFilm {
  Window window;
  bool empty = true;                         // no samples yet: the sums are 0, whatever they hold
  std::vector<AlignedArray<double>> sums;    // averaged channels, in layer order
  std::vector<AlignedArray<float>> nearest;  // P and Z channels, in layer order
  std::vector<AlignedArray<uint32_t>> ids;   // id channels, in layer order
  AlignedArray<double> nearest_distance;     // of the sample they come from, pixels squared
};

// A finished strip, channels in the order of StripChannels. Id channels hold uint32_t.
struct Strip {
  Window window;
  std::vector<std::vector<float>> colors;  // all float channels, in order
  std::vector<std::vector<uint32_t>> ids;  // all uint channels, in order
};

// The channels of a strip's files: float channels first, then ids.
std::vector<ChannelSpec> StripChannels(const std::vector<Layer>& layers, PixelType color_type);

// Gives the strip the plan's channels with room for the window, whatever it held before.
void StartStrip(const RenderPlan& plan, const Window& window, Strip* strip);

// Empties the tile's channels. `tile` has at most kBatchCapacity pixels.
void StartTile(const RenderPlan& plan, const Window& tile, TileFilm* film);

// Divides by the number of samples, rounds to float and puts the tile into its strip.
void ResolveTile(const RenderPlan& plan, const TileFilm& film, Strip* strip);

}  // namespace nacre
