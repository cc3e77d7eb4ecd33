// SPDX-License-Identifier: Apache-2.0
#include "compare/metrics.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/float_mode.h"
#include "base/parallel.h"
#include "compare/metrics_rows.h"

namespace nacre {
namespace {

// The index, in ascending order, of the 99.9th percentile of `count` values.
size_t RankOf999(size_t count) {
  return count == 0 ? 0 : static_cast<size_t>(std::ceil(0.999 * static_cast<double>(count))) - 1;
}

// The errors in some rows of one channel.
struct BandErrors {
  explicit BandErrors(size_t kept) : relative(kept) {}

  ErrorSums sums;
  size_t nonfinite_mismatches = 0;
  double largest = 0;  // infinite if a sample is not finite in only one image
  DifferenceSite largest_at;
  LargestErrors relative;
};

// Adds a sample of a row with values that are not finite.
void AddSample(float got, float reference, BandErrors* band) {
  const double error = SampleError(got, reference);
  band->nonfinite_mismatches += std::isinf(error);
  if (std::isinf(error) || !std::isfinite(reference)) return;  // or it is the same in both images
  band->sums.Add({.finite = 1,
                  .relative = reference == 0 ? size_t{0} : size_t{1},
                  .zero_mismatches = reference == 0 && error > 0 ? size_t{1} : size_t{0},
                  .squares = error * error,
                  .softened_squares = SoftenedSquare(error, reference),
                  .sum_got = got,
                  .sum_reference = reference,
                  .largest = error,
                  .peak = std::abs(reference),
                  .largest_relative = reference == 0 ? 0 : RelativeError(error, reference)});
  if (reference != 0) band->relative.Add(RelativeToFloat(RelativeError(error, reference)));
}

void AddRow(const float* got, const float* reference, int width, int x0, int y,
            const std::string& channel, BandErrors* band) {
  ErrorSums sums;
  const bool finite = SumRow(got, reference, static_cast<size_t>(width), &sums, &band->relative);
  band->sums.Add(sums);
  if (finite && sums.largest <= band->largest) return;
  for (int x = 0; x < width; ++x) {
    if (!finite) AddSample(got[x], reference[x], band);
    const double error = SampleError(got[x], reference[x]);
    if (error <= band->largest) continue;
    band->largest = error;
    band->largest_at = {x0 + x, y, channel, got[x], reference[x]};
  }
}

// The 99.9th percentile of `count` relative errors. `largest` has more than a thousandth of them,
// the largest ones, except for zeros.
double Quantile999(size_t count, std::vector<float>* largest) {
  const size_t above = count - RankOf999(count);  // including the percentile itself
  if (count == 0 || largest->size() < above) return 0;
  const auto place = largest->begin() + static_cast<std::ptrdiff_t>(above - 1);
  std::nth_element(largest->begin(), place, largest->end(), std::greater<>());
  return *place;
}

}  // namespace

LayerMetrics CompareLayer(const ImagePair& pair, const LayerPair& layer) {
  constexpr int kBandRows = 64;
  const Window& window = pair.window;
  const auto bands = static_cast<size_t>((window.height() + kBandRows - 1) / kBandRows);
  LayerMetrics metrics;
  metrics.layer = layer.layer;
  metrics.samples = layer.channels.size() * window.pixel_count();
  const size_t kept = metrics.samples - RankOf999(metrics.samples);
  std::vector<BandErrors> errors(layer.channels.size() * bands, BandErrors(kept));
  ParallelFor(errors.size(), 0, [&](size_t i) {
    const DefaultFloatMode keep_denormals;
    const ChannelPair& channel = layer.channels[i / bands];
    const int first = window.y0 + static_cast<int>(i % bands) * kBandRows;
    for (int y = first; y < std::min(first + kBandRows, window.y1); ++y) {
      AddRow(channel.got + pair.GotIndex(window.x0, y),
             channel.reference + pair.ReferenceIndex(window.x0, y), window.width(), window.x0, y,
             channel.name, &errors[i]);
    }
  });
  ErrorSums sums;
  double largest = 0;
  std::vector<float> relative;
  for (const BandErrors& band : errors) {  // in order: the first of equal errors is reported
    sums.Add(band.sums);
    metrics.nonfinite_mismatches += band.nonfinite_mismatches;
    const std::vector<float>& of_band = band.relative.errors();
    relative.insert(relative.end(), of_band.begin(), of_band.end());
    if (band.largest <= largest) continue;
    largest = band.largest;
    metrics.max_abs_at = band.largest_at;
  }
  if (sums.finite == 0) return metrics;
  const auto count = static_cast<double>(sums.finite);
  metrics.rmse = std::sqrt(sums.squares / count);
  metrics.rel_mse = sums.softened_squares / count;
  metrics.max_abs = sums.largest;
  metrics.psnr_peak = sums.peak;
  if (metrics.rmse > 0) {
    metrics.psnr_db = 20 * std::log10(metrics.psnr_peak / metrics.rmse);
  }
  metrics.mean_got = sums.sum_got / count;
  metrics.mean_reference = sums.sum_reference / count;
  metrics.max_rel = sums.largest_relative;
  metrics.p999_rel = Quantile999(sums.relative, &relative);
  metrics.zero_mismatches = sums.zero_mismatches;
  return metrics;
}

}  // namespace nacre
