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
  film->window = tile;
  film->empty = true;
  const auto count = [&](ChannelKind kind) {
    return static_cast<size_t>(std::count(plan.channels.begin(), plan.channels.end(), kind));
  };
  while (film->sums.size() < count(ChannelKind::kAveraged)) {
    film->sums.emplace_back(kBatchCapacity);
  }
  while (film->nearest.size() < count(ChannelKind::kNearest)) {
    film->nearest.emplace_back(kBatchCapacity);
  }
  while (film->ids.size() < count(ChannelKind::kId)) film->ids.emplace_back(kBatchCapacity);
  if (film->nearest.empty() && film->ids.empty()) return;
  const size_t pixels = tile.pixel_count();
  if (film->nearest_distance.size() == 0) {
    film->nearest_distance = AlignedArray<double>(kBatchCapacity);
  }
  std::fill_n(film->nearest_distance.data(), pixels, std::numeric_limits<double>::infinity());
  for (AlignedArray<float>& channel : film->nearest) std::fill_n(channel.data(), pixels, 0.0f);
  for (AlignedArray<uint32_t>& channel : film->ids) std::fill_n(channel.data(), pixels, 0u);
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
