// SPDX-License-Identifier: Apache-2.0
// api/compare.cc: comparisons of the public API.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "api/border.h"
#include "compare/heat_map.h"
#include "compare/perceptual.h"
#include "compare/verdict.h"

namespace nacre::v0 {
namespace {

LayerMetrics ToPublic(const nacre::LayerMetrics& own) {
  LayerMetrics metrics;
  metrics.layer = own.layer;
  metrics.samples = own.samples;
  metrics.rmse = own.rmse;
  metrics.rel_mse = own.rel_mse;
  metrics.psnr_db = own.psnr_db;
  metrics.max_abs = own.max_abs;
  metrics.max_rel = own.max_rel;
  metrics.zero_mismatches = own.zero_mismatches;
  metrics.mean = own.mean_got;
  metrics.mean_reference = own.mean_reference;
  return metrics;
}

void CopyPerceptual(const PerceptualMetrics& own, std::vector<LayerMetrics>* layers) {
  for (LayerMetrics& layer : *layers) {
    if (layer.layer != own.layer) continue;
    layer.ssim = own.ssim;
    layer.flip = own.flip_mean;
    layer.hdr_flip = own.hdr_flip_mean;
  }
}

// Written so that NaN is refused.
void RequireUpTo(double value, double most, const char* setting) {
  if (value >= 0 && value <= most) return;
  throw nacre::Error(ExitCode::kUsage, std::string("CompareSettings::") + setting,
                     fmt::format("{} is out of range", value),
                     most == 1 ? "it is from 0 to 1" : "it is 0 or more");
}

void CheckSettings(const CompareSettings& settings) {
  const double infinity = std::numeric_limits<double>::infinity();
  RequireUpTo(settings.max_abs, infinity, "max_abs");
  RequireUpTo(settings.max_rel, infinity, "max_rel");
  RequireUpTo(settings.exceeding_fraction, 1, "exceeding_fraction");
  RequireUpTo(settings.max_rmse, infinity, "max_rmse");
}

}  // namespace

Picture HeatMap(const Image& image, const Image& reference, const HeatMapSettings& settings) {
  return AtBorder([&] {
    if (!(settings.low > 0 && settings.low < settings.high && std::isfinite(settings.high))) {
      throw nacre::Error(
          ExitCode::kUsage, "HeatMapSettings",
          fmt::format("the scale from {} to {} is out of range", settings.low, settings.high),
          "0 < low < high");
    }
    const Rgb8Picture map =
        nacre::HeatMap(ToOwn(image), ToOwn(reference), settings.layer,
                       settings.relative ? HeatQuantity::kRelative : HeatQuantity::kAbsolute,
                       {settings.low, settings.high});
    Picture picture{map.width, map.height, {}};
    picture.rgba.resize(map.rgb8.size() / 3 * 4, 255);
    for (size_t i = 0; i < map.rgb8.size() / 3; ++i) {
      std::copy_n(map.rgb8.data() + 3 * i, 3, picture.rgba.data() + 4 * i);
    }
    return picture;
  });
}

Comparison Compare(const Image& image, const Image& reference, const CompareSettings& settings) {
  return AtBorder([&] {
    CheckSettings(settings);
    const nacre::Image got = ToOwn(image);
    const nacre::Image expected = ToOwn(reference);
    const nacre::CompareOptions options{.layers = settings.layers, .crop = settings.crop};
    const nacre::Tolerances tolerances{.max_abs = settings.max_abs,
                                       .max_rel = settings.max_rel,
                                       .exceeding_fraction = settings.exceeding_fraction,
                                       .rmse = settings.max_rmse};
    const nacre::Verdict verdict = Judge(got, expected, tolerances, options);
    Comparison comparison;
    comparison.match = verdict.match;
    comparison.reason = verdict.reason;
    comparison.pixels = verdict.pixels;
    comparison.exceeding_pixels = verdict.exceeding_pixels;
    for (const nacre::LayerMetrics& layer : verdict.layers) {
      comparison.layers.push_back(ToPublic(layer));
    }
    if (settings.perceptual) {
      for (const PerceptualMetrics& layer : MeasurePerceptual(got, expected, {}, options)) {
        CopyPerceptual(layer, &comparison.layers);
      }
    }
    return comparison;
  });
}

}  // namespace nacre::v0
