// SPDX-License-Identifier: Apache-2.0
#include "render/film.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "hit/batch.h"

namespace nacre {
namespace {

template <typename T>
void CopyTile(const AlignedArray<T>& from, const PixelRows<T>& rows) {
  for (size_t y = 0; y < rows.height; ++y) {
    std::copy_n(from.data() + y * rows.width, rows.width, rows.first + y * rows.stride);
  }
}

// Points the channels to buffers of at least `pixels` pixels.
template <typename T>
void UseBuffers(size_t pixels, std::vector<AlignedArray<T>>* buffers,
                std::vector<std::span<T>>* channels) {
  buffers->resize(channels->size());
  for (size_t i = 0; i < channels->size(); ++i) {
    AlignedArray<T>& buffer = (*buffers)[i];
    if (buffer.size() < pixels) buffer = AlignedArray<T>(pixels);
    (*channels)[i] = {buffer.data(), pixels};
  }
}

size_t CountChannels(const FilmPlan& plan, ChannelKind kind) {
  return static_cast<size_t>(std::ranges::count(plan.channels, kind, &PlannedChannel::kind));
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

std::vector<Layer> PlanLayers(const Scene& scene, const RenderSettings& settings,
                              Explanation* why) {
  std::vector<Layer> layers = ParseLayers(settings.layers, scene);
  std::string names;
  for (size_t i = 2; i < layers.size(); ++i) {
    names += (names.empty() ? "" : ", ") + layers[i].name;
  }
  why->items.push_back(
      {"layers", !names.empty(), names.empty() ? "only beauty and alpha are rendered" : names});
  return layers;
}

bool ShowsNearest(const std::vector<Layer>& layers) {
  return std::any_of(layers.begin(), layers.end(),
                     [](const Layer& layer) { return !IsAveraged(layer.kind); });
}

FilmPlan PlanFilm(const Scene& scene, const RenderSettings& settings, std::vector<Layer> layers,
                  const CameraFrame& camera, const LightsPlan& lights, const PixelSampler& sampler,
                  Explanation* why) {
  FilmPlan plan;
  plan.layers = std::move(layers);
  plan.camera = camera;
  plan.spp = scene.image.spp;
  plan.weight = 0;
  for (int i = 0; i < plan.spp; ++i) plan.weight += SampleWeight(sampler, i);
  plan.background = lights.background;
  plan.sky = lights.sky.has_value();
  for (const Layer& layer : plan.layers) {
    const Rgb background = BackgroundOf(layer, plan);
    const bool averaged = IsAveraged(layer.kind);
    for (int c = 0; c < FloatChannels(layer.kind); ++c) {
      plan.channels.push_back(
          {averaged ? ChannelKind::kAveraged : ChannelKind::kNearest, background[c]});
    }
    if (FloatChannels(layer.kind) == 0) plan.channels.push_back({ChannelKind::kId, 0});
  }
  const char* const reason = settings.max_error > 0  ? "pixels take as many samples as they need"
                             : plan.spp > 1          ? "a pixel takes several samples"
                             : settings.general_path ? "the general path is asked for"
                             : ShowsNearest(plan.layers) ? "some layers are not averages"
                             : plan.sky                  ? "every pixel shows the sky or a hit"
                             : !HasUnitWeights(sampler)  ? "samples have weights"
                                                         : nullptr;
  plan.one_sample = reason == nullptr;
  why->items.push_back({"sums of samples", !plan.one_sample,
                        plan.one_sample ? "a pixel's only sample is its value" : reason});
  return plan;
}

void StartStrip(const FilmPlan& plan, const Window& window, Image* image, Strip* strip) {
  const size_t ids = CountChannels(plan, ChannelKind::kId);
  strip->window = window;
  strip->colors.resize(plan.channels.size() - ids);
  strip->ids.resize(ids);
  const size_t pixels = window.pixel_count();
  UseBuffers(pixels, &strip->id_buffers, &strip->ids);
  if (image == nullptr) return UseBuffers(pixels, &strip->color_buffers, &strip->colors);
  for (size_t i = 0; i < strip->colors.size(); ++i) {
    const size_t first = IndexIn(image->data, window.x0, window.y0);
    strip->colors[i] = std::span(image->channels[i].samples).subspan(first, pixels);
  }
}

void StartTile(const FilmPlan& plan, const Window& tile, size_t capacity, TileFilm* film) {
  film->window = tile;
  const auto make_room = [&](ChannelKind kind, auto* channels) {
    while (channels->size() < CountChannels(plan, kind)) channels->emplace_back(capacity);
  };
  make_room(ChannelKind::kAveraged, &film->sums);
  const size_t pixels = tile.pixel_count();
  for (AlignedArray<double>& sums : film->sums) std::fill_n(sums.data(), pixels, 0.0);
  make_room(ChannelKind::kNearest, &film->nearest);
  make_room(ChannelKind::kId, &film->ids);
  if (film->nearest.empty() && film->ids.empty()) return;
  if (film->nearest_distance2.size() == 0) {
    film->nearest_distance2 = AlignedArray<double>(capacity);
  }
  std::fill_n(film->nearest_distance2.data(), pixels, std::numeric_limits<double>::infinity());
  for (AlignedArray<float>& channel : film->nearest) std::fill_n(channel.data(), pixels, 0.0f);
  for (AlignedArray<uint32_t>& channel : film->ids) std::fill_n(channel.data(), pixels, 0u);
}

// Not inlined: where GCC 12 vectorises double(float(x)) it otherwise omits the rounding.
[[gnu::noinline]] static float Rounded(double value) { return static_cast<float>(value); }

Rgb RoundToFloat(const Rgb& value) {
  return {Rounded(value.x), Rounded(value.y), Rounded(value.z)};
}

bool ShowsBackground(const Layer& layer) {
  return layer.kind == LayerKind::kBeauty || layer.kind == LayerKind::kEmission;
}

Rgb BackgroundOf(const Layer& layer, const FilmPlan& plan) {
  const bool shows = ShowsBackground(layer) && !plan.sky;
  return shows ? RoundToFloat(plan.background) : Rgb(0, 0, 0);
}

void FillBackground(const FilmPlan& plan, const Window& tile, Strip* strip) {
  size_t color = 0;
  for (const PlannedChannel& channel : plan.channels) {
    if (channel.kind == ChannelKind::kId) continue;
    // Computed as if from sums of 0, so that a background of -0 becomes 0.
    const double mean = (0.0 + channel.background * plan.weight) * (1.0 / plan.spp);
    FillPixels(static_cast<float>(mean), RowsIn(strip->window, tile, strip->colors[color++]));
  }
  for (const std::span<uint32_t> channel : strip->ids) {
    const PixelRows<uint32_t> rows = RowsIn(strip->window, tile, channel);
    for (size_t y = 0; y < rows.height; ++y) {
      std::fill_n(rows.first + y * rows.stride, rows.width, 0u);
    }
  }
}

void ResolveTile(const FilmPlan& plan, const TileFilm& film, Strip* strip) {
  const size_t pixels = CountPixels(film.runs);
  if (pixels < film.window.pixel_count()) FillBackground(plan, film.window, strip);
  if (pixels == 0) return;
  const double* const coverage = film.sums[kAlphaSum].data();
  size_t sum = 0, nearest = 0, color = 0;
  for (const auto& [kind, background] : plan.channels) {
    if (kind == ChannelKind::kId) continue;
    const PixelRows<float> rows = RowsIn(strip->window, film.window, strip->colors[color++]);
    if (kind == ChannelKind::kAveraged) {
      RoundSums(film.sums[sum++].data(), coverage, {background, plan.weight, 1.0 / plan.spp},
                film.runs, film.window, rows);
    } else {
      CopyTile(film.nearest[nearest++], rows);
    }
  }
  for (size_t id = 0; id < strip->ids.size(); ++id) {
    CopyTile(film.ids[id], RowsIn(strip->window, film.window, strip->ids[id]));
  }
}

}  // namespace nacre
