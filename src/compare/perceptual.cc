// SPDX-License-Identifier: Apache-2.0
#include "compare/perceptual.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "color/display.h"
#include "compare/ssim.h"

namespace nacre {
namespace {

bool IsDisplayReferred(const Image& image) {
  const auto transfer = image.metadata.find("transfer");
  return transfer != image.metadata.end() && transfer->second == "display";
}

// The channel of the layer whose name ends in R, G or B; null if there is none.
const ChannelPair* FindColor(const LayerPair& layer, char color) {
  for (const ChannelPair& channel : layer.channels) {
    // Without a dot, rfind() + 1 is 0.
    if (channel.name.substr(channel.name.rfind('.') + 1) == std::string(1, color)) return &channel;
  }
  return nullptr;
}

bool IsColor(const LayerPair& layer) {
  return FindColor(layer, 'R') && FindColor(layer, 'G') && FindColor(layer, 'B');
}

// The colours of both images unchanged: radiance, or display values.
struct Colors {
  PictureView got, reference;
};

Colors GetColors(const ImagePair& pair, const LayerPair& layer) {
  Colors colors;
  colors.got = {pair.window.width(), pair.window.height(), {}, pair.got_stride};
  colors.reference = {pair.window.width(), pair.window.height(), {}, pair.reference_stride};
  constexpr char kNames[] = {'R', 'G', 'B'};
  for (size_t c = 0; c < 3; ++c) {
    const ChannelPair* const channel = FindColor(layer, kNames[c]);
    colors.got.rgb[c] = channel->got;
    colors.reference.rgb[c] = channel->reference;
  }
  return colors;
}

// The number of pixels that are not finite in one of the pictures, and the first of them.
struct NonfinitePixels {
  size_t count = 0;
  int x = 0, y = 0;
};

NonfinitePixels FindNonfinite(const Colors& colors) {
  NonfinitePixels found;
  const auto is_finite = [](const PictureView& picture, int x, int y) {
    const size_t i = static_cast<size_t>(y) * picture.stride + static_cast<size_t>(x);
    return std::isfinite(picture.rgb[0][i]) && std::isfinite(picture.rgb[1][i]) &&
           std::isfinite(picture.rgb[2][i]);
  };
  for (int y = 0; y < colors.got.height; ++y) {
    for (int x = 0; x < colors.got.width; ++x) {
      if (is_finite(colors.got, x, y) && is_finite(colors.reference, x, y)) continue;
      if (found.count++ == 0) {
        found.x = x;
        found.y = y;
      }
    }
  }
  return found;
}

// Converts to linear display light in [0, 1].
ShowFunction MakeShow(bool display_referred, const DisplaySettings& display) {
  if (display_referred) {
    return [](size_t count, float* r, float* g, float* b) {
      for (float* channel : {r, g, b}) DecodeSrgb(count, channel);
    };
  }
  return
      [display](size_t count, float* r, float* g, float* b) { ShowLight(display, count, r, g, b); };
}

void MeasureShown(const Colors& colors, const ShowPair& show, const PerceptualOptions& what,
                  PerceptualMetrics* metrics) {
  constexpr int kSide = 2 * kSsimRadius + 1;
  const int width = colors.got.width, height = colors.got.height;
  if (what.ssim && std::min(width, height) < kSide) {
    metrics->notes.push_back(fmt::format("no SSIM: {}x{} is smaller than its window of {}x{}",
                                         width, height, kSide, kSide));
  } else if (what.ssim) {
    metrics->ssim = Ssim(width, height, ShownGreys(colors.got, show.test),
                         ShownGreys(colors.reference, show.reference));
  }
  if (!what.flip) return;
  metrics->flip_map =
      FlipMap(colors.reference, colors.got, std::span(&show, 1), what.pixels_per_degree);
  metrics->flip_mean = Mean(metrics->flip_map);
  metrics->flip_max = Largest(metrics->flip_map);
}

void MeasureHdr(const Colors& colors, const PerceptualOptions& what, PerceptualMetrics* metrics) {
  ExposureRange range = FlipExposures(colors.reference);
  range.start = what.start_exposure.value_or(range.start);
  range.stop = what.stop_exposure.value_or(range.stop);
  range.count = what.exposures.value_or(
      std::max(range.count == 1 ? 1 : 2, static_cast<int>(std::ceil(range.stop - range.start))));
  if (range.stop < range.start) {
    metrics->notes.push_back(fmt::format("no HDR-FLIP: its exposures end at {:.3g}, before {:.3g}",
                                         range.stop, range.start));
    return;
  }
  metrics->exposures = range;
  metrics->hdr_flip_map = HdrFlipMap(colors.reference, colors.got, range, what.pixels_per_degree);
  metrics->hdr_flip_mean = Mean(metrics->hdr_flip_map);
  metrics->hdr_flip_max = Largest(metrics->hdr_flip_map);
}

}  // namespace

std::vector<PerceptualMetrics> MeasurePerceptual(const Image& got, const Image& reference,
                                                 const PerceptualOptions& what,
                                                 const CompareOptions& options) {
  const ImagePair pair = PairImages(got, reference, options);
  const bool got_display = IsDisplayReferred(got);
  const bool reference_display = IsDisplayReferred(reference);
  std::vector<PerceptualMetrics> all;
  for (const LayerPair& layer : pair.layers) {
    if (!IsColor(layer)) continue;
    PerceptualMetrics& metrics = all.emplace_back();
    metrics.layer = layer.layer;
    const Colors colors = GetColors(pair, layer);
    if (const NonfinitePixels nonfinite = FindNonfinite(colors); nonfinite.count > 0) {
      metrics.notes.push_back(
          fmt::format("no SSIM or FLIP: {} pixels are not finite, the first at ({}, {})",
                      nonfinite.count, pair.window.x0 + nonfinite.x, pair.window.y0 + nonfinite.y));
      continue;
    }
    const ShowPair show = {MakeShow(reference_display, what.display),
                           MakeShow(got_display, what.display),
                           /*alike=*/got_display == reference_display};
    MeasureShown(colors, show, what, &metrics);
    if (!what.hdr_flip) continue;
    if (got_display || reference_display) {
      metrics.notes.emplace_back(
          "no HDR-FLIP: it is for linear images, and one is display-referred");
    } else {
      MeasureHdr(colors, what, &metrics);
    }
  }
  return all;
}

}  // namespace nacre
