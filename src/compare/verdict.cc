// SPDX-License-Identifier: Apache-2.0
#include "compare/verdict.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/float_mode.h"
#include "base/parallel.h"
#include "compare/metrics_rows.h"

namespace nacre {
namespace {

bool Exceeds(float got, float reference, const Tolerances& tolerances) {
  const double error = SampleError(got, reference);
  if (error == 0) return false;
  if (std::isinf(error)) return true;
  return error > tolerances.max_abs + tolerances.max_rel * std::abs(static_cast<double>(reference));
}

// The number of pixels beyond their tolerance, and the sample with the largest error among them,
// the first in the order of rows, pixels and layers.
struct Excess {
  size_t pixels = 0;
  double worst = 0;
  DifferenceSite worst_at;
};

// Finds the excess in row `y`.
class RowExcess {
 public:
  RowExcess(const ImagePair& pair, const Tolerances& tolerances)
      : pair_(pair),
        tolerances_(tolerances),
        width_(static_cast<size_t>(pair.window.width())),
        marks_((width_ + sizeof(uint64_t) - 1) / sizeof(uint64_t)) {}

  void Add(int y, Excess* excess) {
    std::fill(marks_.begin(), marks_.end(), uint64_t{0});
    bool finite = true;
    double largest = 0;
    for (const LayerPair& layer : pair_.layers) {
      for (const ChannelPair& channel : layer.channels) {
        finite = finite && MarkExcess(channel.got + pair_.GotIndex(pair_.window.x0, y),
                                      channel.reference + pair_.ReferenceIndex(pair_.window.x0, y),
                                      width_, tolerances_.max_abs, tolerances_.max_rel,
                                      reinterpret_cast<uint8_t*>(marks_.data()), &largest);
      }
    }
    if (finite) {
      for (const uint64_t marks : marks_) {
        excess->pixels += static_cast<size_t>(std::popcount(marks));
      }
    }
    if (!finite || largest > excess->worst) AddSamples(y, /*count=*/!finite, excess);
  }

 private:
  // Compares sample by sample, for rows with values that are not finite, or to find the worst
  // sample.
  void AddSamples(int y, bool count, Excess* excess) {
    for (int x = pair_.window.x0; x < pair_.window.x1; ++x) {
      bool exceeds = false;
      for (const LayerPair& layer : pair_.layers) {
        for (const ChannelPair& channel : layer.channels) {
          const float got = channel.got[pair_.GotIndex(x, y)];
          const float reference = channel.reference[pair_.ReferenceIndex(x, y)];
          if (!Exceeds(got, reference, tolerances_)) continue;
          exceeds = true;
          const double size = SampleError(got, reference);
          if (size > excess->worst) {
            excess->worst = size;
            excess->worst_at = {x, y, channel.name, got, reference};
          }
        }
      }
      excess->pixels += exceeds && count;
    }
  }

  const ImagePair& pair_;
  const Tolerances& tolerances_;
  size_t width_;
  std::vector<uint64_t> marks_;  // eight bytes of MarkExcess each
};

Excess FindExcess(const ImagePair& pair, const Tolerances& tolerances) {
  constexpr int kBandRows = 64;
  const Window& window = pair.window;
  std::vector<Excess> bands(static_cast<size_t>((window.height() + kBandRows - 1) / kBandRows));
  ParallelFor(bands.size(), 0, [&](size_t i) {
    const DefaultFloatMode keep_denormals;
    RowExcess row(pair, tolerances);
    const int first = window.y0 + static_cast<int>(i) * kBandRows;
    for (int y = first; y < std::min(first + kBandRows, window.y1); ++y) row.Add(y, &bands[i]);
  });
  Excess excess;
  for (Excess& band : bands) {
    excess.pixels += band.pixels;
    if (band.worst <= excess.worst) continue;
    excess.worst = band.worst;
    excess.worst_at = std::move(band.worst_at);
  }
  return excess;
}

std::string WindowInWords(const Window& window) {
  return fmt::format("{}x{} at {},{}", window.width(), window.height(), window.x0, window.y0);
}

// Describes how the windows differ; "" if they do not.
std::string WindowsInWords(const Image& got, const Image& reference) {
  if (got.display != reference.display) {
    return fmt::format("the display window is {}, not {}", WindowInWords(got.display),
                       WindowInWords(reference.display));
  }
  if (got.data != reference.data) {
    return fmt::format("the data window is {}, not {}", WindowInWords(got.data),
                       WindowInWords(reference.data));
  }
  return {};
}

// Whether only the RMSE is limited. Then single samples are not judged, since the default, that
// they must be equal, would make the limit pointless.
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
  if (by_rmse) of_samples.max_abs = HUGE_VAL;  // which values that are not finite still exceed
  const Excess excess = FindExcess(pair, of_samples);
  verdict.exceeding_pixels = excess.pixels;
  const std::string windows = WindowsInWords(got, reference);
  const bool windows_count = !windows.empty() && !options.crop;
  const double fraction = static_cast<double>(excess.pixels) / static_cast<double>(verdict.pixels);
  if (fraction > tolerances.exceeding_fraction) {
    // Of equal errors, report the one that the layer's metrics name.
    DifferenceSite at = excess.worst_at;
    for (const LayerMetrics& layer : verdict.layers) {
      const DifferenceSite& largest = layer.max_abs_at;
      if (SampleError(largest.got, largest.reference) == excess.worst &&
          Exceeds(largest.got, largest.reference, of_samples)) {
        at = largest;
        break;
      }
    }
    verdict.reason = fmt::format(
        "{}{} of {} pixels ({:.3g} %) {}, {:.3g} % may; worst {} at ({}, {}): {} instead of {}",
        windows_count ? windows + "; " : "", excess.pixels, verdict.pixels, 100 * fraction,
        LimitInWords(tolerances), 100 * tolerances.exceeding_fraction, at.channel, at.x, at.y,
        at.got, at.reference);
    return verdict;
  }
  for (const LayerMetrics& layer : verdict.layers) {
    if (layer.rmse <= tolerances.rmse) continue;
    verdict.reason =
        fmt::format("RMSE of {} is {:.6g}, {:.6g} is allowed",
                    layer.layer.empty() ? "R, G, B" : layer.layer, layer.rmse, tolerances.rmse);
    return verdict;
  }
  if (windows_count) {
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
