// SPDX-License-Identifier: Apache-2.0
#include "compare/verdict.h"

#include <cmath>

#include <fmt/format.h>

namespace nacre {
namespace {

bool Exceeds(float got, float reference, const Tolerances& tolerances) {
  const double error = SampleError(got, reference);
  if (error == 0) return false;
  if (std::isinf(error)) return true;
  return error > tolerances.max_abs + tolerances.max_rel * std::abs(static_cast<double>(reference));
}

// The first sample with the largest SoftenedError of those beyond their tolerance, over all layers.
struct Excess {
  size_t pixels = 0;
  double worst = 0;
  DifferenceSite worst_at;
};

Excess FindExcess(const ImagePair& pair, const Tolerances& tolerances) {
  Excess excess;
  const Window& window = pair.window;
  for (int y = window.y0; y < window.y1; ++y) {
    for (int x = window.x0; x < window.x1; ++x) {
      bool exceeds = false;
      for (const LayerPair& layer : pair.layers) {
        for (const ChannelPair& channel : layer.channels) {
          const float got = channel.got[pair.GotIndex(x, y)];
          const float reference = channel.reference[pair.ReferenceIndex(x, y)];
          if (!Exceeds(got, reference, tolerances)) continue;
          exceeds = true;
          const double softened = SoftenedError(SampleError(got, reference), reference);
          // An infinite reference makes inf / inf.
          const double size = std::isnan(softened) ? HUGE_VAL : softened;
          if (size > excess.worst) {
            excess.worst = size;
            excess.worst_at = {x, y, channel.name, got, reference};
          }
        }
      }
      excess.pixels += exceeds;
    }
  }
  return excess;
}

std::string WindowInWords(const Window& window) {
  return fmt::format("{}x{} at {},{}", window.width(), window.height(), window.x0, window.y0);
}

// How the windows differ; "" if they do not.
std::string WindowsInWords(const Image& got, const Image& reference) {
  if (got.data != reference.data) {
    return fmt::format("the data window is {}, not {}", WindowInWords(got.data),
                       WindowInWords(reference.data));
  }
  if (got.display != reference.display) {
    return fmt::format("the display window is {}, not {}", WindowInWords(got.display),
                       WindowInWords(reference.display));
  }
  return {};
}

// Nothing is said of single samples: images that are equal need no limit of their RMSE.
bool RmseAloneDecides(const Tolerances& tolerances) {
  return std::isfinite(tolerances.rmse) && tolerances.max_abs == 0 && tolerances.max_rel == 0 &&
         tolerances.exceeding_fraction == 0;
}

std::string LimitInWords(const Tolerances& tolerances) {
  if (tolerances.max_abs == 0 && tolerances.max_rel == 0) return "differ";
  if (tolerances.max_rel == 0) return fmt::format("differ by more than {}", tolerances.max_abs);
  return fmt::format("differ by more than {} + {} |reference|", tolerances.max_abs,
                     tolerances.max_rel);
}

}  // namespace

Verdict Judge(const Image& got, const Image& reference, const Tolerances& tolerances,
              const CompareOptions& options) {
  const ImagePair pair = PairImages(got, reference, options);
  Verdict verdict;
  verdict.pixels = pair.window.pixel_count();
  for (const LayerPair& layer : pair.layers) verdict.layers.push_back(CompareLayer(pair, layer));
  const bool by_rmse = RmseAloneDecides(tolerances);
  Tolerances of_samples = tolerances;
  if (by_rmse) of_samples.max_abs = HUGE_VAL;  // which what is not finite exceeds still
  const Excess excess = FindExcess(pair, of_samples);
  verdict.exceeding_pixels = excess.pixels;
  const double fraction = static_cast<double>(excess.pixels) / static_cast<double>(verdict.pixels);
  if (fraction > tolerances.exceeding_fraction) {
    const DifferenceSite& at = excess.worst_at;
    verdict.reason = fmt::format(
        "{} of {} pixels ({:.3g} %) {}, {:.3g} % may; worst {} at ({}, {}): {} instead of {}",
        excess.pixels, verdict.pixels, 100 * fraction, LimitInWords(tolerances),
        100 * tolerances.exceeding_fraction, at.channel, at.x, at.y, at.got, at.reference);
    return verdict;
  }
  for (const LayerMetrics& layer : verdict.layers) {
    if (layer.rmse <= tolerances.rmse) continue;
    verdict.reason =
        fmt::format("RMSE of {} is {:.6g}, {:.6g} is allowed",
                    layer.layer.empty() ? "R, G, B" : layer.layer, layer.rmse, tolerances.rmse);
    return verdict;
  }
  const std::string windows = WindowsInWords(got, reference);
  if (!windows.empty() && !options.crop) {
    verdict.reason = windows + "; the pixels that both have match";
    return verdict;
  }
  verdict.match = true;
  if (by_rmse) {
    verdict.reason = fmt::format("no layer's RMSE is more than {:.6g}", tolerances.rmse);
    return verdict;
  }
  verdict.reason = excess.pixels == 0
                       ? fmt::format("none of {} pixels {}", verdict.pixels,
                                     tolerances.max_abs == 0 && tolerances.max_rel == 0
                                         ? "differs"
                                         : "differs by more than allowed")
                       : fmt::format("{} of {} pixels ({:.3g} %) {}, {:.3g} % may", excess.pixels,
                                     verdict.pixels, 100 * fraction, LimitInWords(tolerances),
                                     100 * tolerances.exceeding_fraction);
  return verdict;
}

}  // namespace nacre
