#include "render/film.h"

#include <algorithm>
#include <limits>

#include "render/film_kernel.h"

namespace nacre {
namespace {

// Calls copy(row of the tile, row of the strip) for each row of a channel.
template <typename From, typename To, typename Copy>
void ForEachRow(const Window& tile, const Window& strip, const From* from, To* to,
                const Copy& copy) {
  for (int y = tile.y0; y < tile.y1; ++y) {
    const auto tile_row = static_cast<size_t>(y - tile.y0) * static_cast<size_t>(tile.width());
    const auto strip_row = static_cast<size_t>(y - strip.y0) * static_cast<size_t>(strip.width());
    copy(from + tile_row, to + strip_row + static_cast<size_t>(tile.x0 - strip.x0));
  }
}

template <typename T>
void CopyTile(const Window& tile, const Window& strip, const AlignedArray<T>& from,
              std::vector<T>* to) {
  ForEachRow(tile, strip, from.data(), to->data(),
             [&](const T* row, T* out) { std::copy_n(row, tile.width(), out); });
}

}  // namespace

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

void StartStrip(const RenderPlan& plan, const Window& window, Strip* strip) {
  size_t ids = 0;
  for (const ChannelKind kind : plan.channels) ids += kind == ChannelKind::kId ? 1 : 0;
  strip->window = window;
  strip->colors.resize(plan.channels.size() - ids);
  strip->ids.resize(ids);
  for (std::vector<float>& channel : strip->colors) channel.resize(window.pixel_count());
  for (std::vector<uint32_t>& channel : strip->ids) channel.resize(window.pixel_count());
}

void StartTile(const RenderPlan& plan, const Window& tile, TileFilm* film) {
  const bool first = film->sums.empty();
  film->window = tile;
  const size_t pixels = tile.pixel_count();
  size_t sum = 0, nearest = 0, id = 0;
  // New arrays hold zeros.
  const auto clear = [&](auto* arrays, size_t i) {
    if (first) {
      arrays->emplace_back(kBatchCapacity);
    } else {
      std::fill_n((*arrays)[i].data(), pixels, 0);
    }
  };
  for (const ChannelKind kind : plan.channels) {
    if (kind == ChannelKind::kAveraged) clear(&film->sums, sum++);
    if (kind == ChannelKind::kNearest) clear(&film->nearest, nearest++);
    if (kind == ChannelKind::kId) clear(&film->ids, id++);
  }
  if (film->nearest.empty() && film->ids.empty()) return;
  if (first) film->nearest_distance = AlignedArray<double>(kBatchCapacity);
  std::fill_n(film->nearest_distance.data(), pixels, std::numeric_limits<double>::infinity());
}

void ResolveTile(const RenderPlan& plan, const TileFilm& film, Strip* strip) {
  const Window& tile = film.window;
  const double scale = 1.0 / plan.scene->image.spp;
  size_t sum = 0, nearest = 0, id = 0, color = 0;
  for (const ChannelKind kind : plan.channels) {
    if (kind == ChannelKind::kAveraged) {
      ForEachRow(tile, strip->window, film.sums[sum++].data(), strip->colors[color++].data(),
                 [&](const double* row, float* out) {
                   RoundSums(row, scale, static_cast<size_t>(tile.width()), out);
                 });
    } else if (kind == ChannelKind::kNearest) {
      CopyTile(tile, strip->window, film.nearest[nearest++], &strip->colors[color++]);
    } else {
      CopyTile(tile, strip->window, film.ids[id], &strip->ids[id]);
      ++id;
    }
  }
}

}  // namespace nacre
