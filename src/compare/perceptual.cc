// SPDX-License-Identifier: Apache-2.0
#include "compare/perceptual.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "base/error.h"
#include "color/luminance.h"
#include "color/transfer.h"
#include "compare/ssim.h"

namespace nacre {
namespace {

bool IsDisplayReferred(const Image& image) {
  const auto transfer = image.metadata.find("transfer");
  return transfer != image.metadata.end() && transfer->second == "display";
}

// The samples of both images as they are: radiance, or the codes of a display.
struct Colors {
  Planes got, reference;
  size_t nonfinite = 0;  // pixels, of either
  int nonfinite_x = 0, nonfinite_y = 0;
};

// The channel of the layer that ends in R, G or B; null if it has none.
const ChannelPair* FindColor(const LayerPair& layer, char color) {
  for (const ChannelPair& channel : layer.channels) {
    const size_t dot = channel.name.rfind('.');
    const size_t start = dot == std::string::npos ? 0 : dot + 1;
    if (channel.name.substr(start) == std::string(1, color)) return &channel;
  }
  return nullptr;
}

bool IsColor(const LayerPair& layer) {
  return FindColor(layer, 'R') && FindColor(layer, 'G') && FindColor(layer, 'B');
}

Colors GetColors(const ImagePair& pair, const LayerPair& layer) {
  const Window& window = pair.window;
  Colors colors;
  const ChannelPair* const channels[] = {FindColor(layer, 'R'), FindColor(layer, 'G'),
                                         FindColor(layer, 'B')};
  colors.got.fill(Plane(window.width(), window.height()));
  colors.reference = colors.got;
  for (int y = window.y0; y < window.y1; ++y) {
    for (int x = window.x0; x < window.x1; ++x) {
      bool finite = true;
      for (size_t c = 0; c < 3; ++c) {
        const float got = channels[c]->got[pair.GotIndex(x, y)];
        const float reference = channels[c]->reference[pair.ReferenceIndex(x, y)];
        finite = finite && std::isfinite(got) && std::isfinite(reference);
        colors.got[c].at(x - window.x0, y - window.y0) = std::max(got, 0.0f);
        colors.reference[c].at(x - window.x0, y - window.y0) = std::max(reference, 0.0f);
      }
      if (finite) continue;
      if (colors.nonfinite++ == 0) {
        colors.nonfinite_x = x;
        colors.nonfinite_y = y;
      }
    }
  }
  return colors;
}

// Linear display light in [0, 1].
Planes Show(const Planes& in, bool display_referred, const DisplaySettings& display) {
  Planes out = in;
  for (size_t i = 0; i < in[0].size(); ++i) {
    const Imath::Color3<double> rgb(in[0].values[i], in[1].values[i], in[2].values[i]);
    const Imath::Color3<double> light =
        display_referred
            ? Imath::Color3<double>(SrgbEotf(std::min(rgb.x, 1.0)), SrgbEotf(std::min(rgb.y, 1.0)),
                                    SrgbEotf(std::min(rgb.z, 1.0)))
            : DisplayLight(display, rgb);
    for (size_t c = 0; c < 3; ++c) out[c].values[i] = light[static_cast<int>(c)];
  }
  return out;
}

// The grey that a display is given for the luminance: the greys of 8-bit pictures, which SSIM was
// made for, are encoded too.
Plane Greys(const Planes& light) {
  Plane grey = light[0];
  for (size_t i = 0; i < grey.size(); ++i) {
    grey.values[i] =
        SrgbOetf(Luminance<double>({light[0].values[i], light[1].values[i], light[2].values[i]}));
  }
  return grey;
}

double Mean(const Plane& plane) {
  return std::accumulate(plane.values.begin(), plane.values.end(), 0.0) /
         static_cast<double>(plane.size());
}

double Largest(const Plane& plane) {
  return *std::max_element(plane.values.begin(), plane.values.end());
}

void MeasureShown(const Planes& got, const Planes& reference, const PerceptualOptions& what,
                  PerceptualMetrics* metrics) {
  constexpr int kSide = 2 * kSsimRadius + 1;
  if (what.ssim && std::min(got[0].width, got[0].height) < kSide) {
    metrics->notes.push_back(fmt::format("no SSIM: {}x{} is smaller than its window of {}x{}",
                                         got[0].width, got[0].height, kSide, kSide));
  } else if (what.ssim) {
    metrics->ssim = Ssim(Greys(got), Greys(reference));
  }
  if (!what.flip) return;
  metrics->flip_map = FlipMap(reference, got, what.pixels_per_degree);
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
  HdrFlip flip = HdrFlipMap(colors.reference, colors.got, range, what.pixels_per_degree);
  metrics->hdr_flip_mean = Mean(flip.error);
  metrics->hdr_flip_max = Largest(flip.error);
  metrics->hdr_flip_map = std::move(flip.error);
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
    if (colors.nonfinite > 0) {
      metrics.notes.push_back(
          fmt::format("no SSIM or FLIP: {} pixels are not finite, the first at ({}, {})",
                      colors.nonfinite, colors.nonfinite_x, colors.nonfinite_y));
      continue;
    }
    MeasureShown(Show(colors.got, got_display, what.display),
                 Show(colors.reference, reference_display, what.display), what, &metrics);
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
