#include "render/film.h"

#include <limits>

namespace nacre {

std::vector<ChannelSpec> StripChannels(const std::vector<Layer>& layers, PixelType color_type) {
  std::vector<ChannelSpec> channels;
  std::vector<ChannelSpec> ids;
  for (const Layer& layer : layers) {
    for (const ChannelSpec& channel : LayerChannels(layer, color_type)) {
      (channel.type == PixelType::kUint ? ids : channels).push_back(channel);
    }
  }
  channels.insert(channels.end(), ids.begin(), ids.end());
  return channels;
}

StripFilm MakeStripFilm(const RenderPlan& plan, const Window& window) {
  StripFilm film;
  film.window = window;
  const size_t pixels = window.pixel_count();
  for (const Layer& layer : plan.layers) {
    for (const ChannelSpec& channel : LayerChannels(layer, PixelType::kFloat)) {
      if (IsAveraged(layer.kind)) {
        film.sums.emplace_back(pixels, 0.0);
      } else if (channel.type == PixelType::kUint) {
        film.ids.emplace_back(pixels, 0u);
      } else {
        film.nearest.emplace_back(pixels, 0.0f);
      }
    }
  }
  if (!film.ids.empty() || !film.nearest.empty()) {
    film.nearest_distance.assign(pixels, std::numeric_limits<double>::infinity());
  }
  return film;
}

void AddToChannel(const TileRound& round, const double* values, const Window& strip,
                  std::vector<double>* sums) {
  const double* weight = round.weights;
  for (int y = round.tile.y0; y < round.tile.y1; ++y) {
    double* pixel = sums->data() +
                    static_cast<size_t>(y - strip.y0) * static_cast<size_t>(strip.width()) +
                    static_cast<size_t>(round.tile.x0 - strip.x0);
    for (int x = round.tile.x0; x < round.tile.x1; ++x, ++pixel) {
      double sum = *pixel;
      for (int s = 0; s < round.samples; ++s) sum += *weight++ * *values++;
      *pixel = sum;
    }
  }
}

Strip ResolveFilm(const RenderPlan& plan, const StripFilm& film) {
  Strip strip;
  strip.window = film.window;
  const double scale = 1.0 / plan.scene->image.spp;
  auto sums = film.sums.begin();
  auto nearest = film.nearest.begin();
  for (const Layer& layer : plan.layers) {
    for (const ChannelSpec& channel : LayerChannels(layer, PixelType::kFloat)) {
      if (channel.type == PixelType::kUint) continue;
      if (!IsAveraged(layer.kind)) {
        strip.colors.push_back(*nearest++);
        continue;
      }
      std::vector<float>& out = strip.colors.emplace_back(sums->size());
      for (size_t i = 0; i < out.size(); ++i) out[i] = static_cast<float>((*sums)[i] * scale);
      ++sums;
    }
  }
  strip.ids = film.ids;
  return strip;
}

}  // namespace nacre
