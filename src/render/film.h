// render/film.h: a strip of the picture while its samples come in.
#pragma once

#include <cstdint>
#include <vector>

#include "base/image.h"
#include "render/plan.h"

namespace nacre {

// The strip's pixels, one plane per channel, row by row. Averaged channels are summed in double:
// every layer rounds once, however many samples there are and however their weights cancel, and
// so the layers add up to the beauty.
struct StripFilm {
  Window window;
  std::vector<std::vector<double>> sums;    // averaged channels, in layer order
  std::vector<std::vector<float>> nearest;  // P and Z channels, in layer order
  std::vector<std::vector<uint32_t>> ids;   // id channels, in layer order
  std::vector<double> nearest_distance;     // of the sample they come from, pixels squared
};

// A finished strip, channels in the order of StripChannels. Id channels hold uint32_t.
struct Strip {
  Window window;
  std::vector<std::vector<float>> colors;  // all float channels, in order
  std::vector<std::vector<uint32_t>> ids;  // all uint channels, in order
};

// The channels of a strip's files: float channels first, then ids.
std::vector<ChannelSpec> StripChannels(const std::vector<Layer>& layers, PixelType color_type);

StripFilm MakeStripFilm(const RenderPlan& plan, const Window& window);

// Divides by the number of samples and rounds to float.
Strip ResolveFilm(const RenderPlan& plan, const StripFilm& film);

// One round of samples of a tile: ray (y * tile width + x) * samples + s is sample s of the
// tile's pixel (x, y).
struct TileRound {
  Window tile;
  int samples;
  const double* weights;  // filter weight of each ray
};

// Adds one value per ray to an averaged channel of the tile's pixels.
void AddToChannel(const TileRound& round, const double* values, const Window& strip,
                  std::vector<double>* sums);

}  // namespace nacre
