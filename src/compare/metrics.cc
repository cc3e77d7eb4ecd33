// SPDX-License-Identifier: Apache-2.0
#include "compare/metrics.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace nacre {
namespace {

// Running sums over the samples of a layer.
class Accumulator {
 public:
  explicit Accumulator(std::string layer) { metrics_.layer = std::move(layer); }

  void Add(float got, float reference, int x, int y, const std::string& channel) {
    ++metrics_.samples;
    const double error = SampleError(got, reference);
    if (error > largest_) {
      largest_ = error;
      metrics_.max_abs_at = {x, y, channel, got, reference};
    }
    if (std::isinf(error)) {
      ++metrics_.nonfinite_mismatches;
      return;
    }
    if (!std::isfinite(reference)) return;  // the same in both images
    ++finite_;
    const double relative = RelativeError(error, reference);
    squares_ += error * error;
    relative_squares_ += relative * relative;
    sum_got_ += got;
    sum_reference_ += reference;
    metrics_.max_abs = std::max(metrics_.max_abs, error);
    metrics_.psnr_peak = std::max(metrics_.psnr_peak, std::abs(static_cast<double>(reference)));
    relative_errors_.push_back(static_cast<float>(relative));
  }

  LayerMetrics Finish() {
    if (finite_ == 0) return metrics_;
    const auto count = static_cast<double>(finite_);
    metrics_.rmse = std::sqrt(squares_ / count);
    metrics_.rel_mse = relative_squares_ / count;
    if (metrics_.rmse > 0) {
      metrics_.psnr_db = 20 * std::log10(metrics_.psnr_peak / metrics_.rmse);
    }
    metrics_.mean_got = sum_got_ / count;
    metrics_.mean_reference = sum_reference_ / count;
    const auto rank = static_cast<size_t>(std::ceil(0.999 * count)) - 1;
    const auto nth = relative_errors_.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(relative_errors_.begin(), nth, relative_errors_.end());
    metrics_.p999_rel = *nth;
    metrics_.max_rel = *std::max_element(nth, relative_errors_.end());
    return metrics_;
  }

 private:
  LayerMetrics metrics_;
  size_t finite_ = 0;
  double largest_ = 0;
  double squares_ = 0, relative_squares_ = 0, sum_got_ = 0, sum_reference_ = 0;
  std::vector<float> relative_errors_;
};

}  // namespace

LayerMetrics CompareLayer(const ImagePair& pair, const LayerPair& layer) {
  Accumulator accumulator(layer.layer);
  const Window& window = pair.window;
  for (const ChannelPair& channel : layer.channels) {
    for (int y = window.y0; y < window.y1; ++y) {
      for (int x = window.x0; x < window.x1; ++x) {
        accumulator.Add(channel.got[pair.GotIndex(x, y)],
                        channel.reference[pair.ReferenceIndex(x, y)], x, y, channel.name);
      }
    }
  }
  return accumulator.Finish();
}

std::vector<LayerMetrics> CompareImages(const Image& got, const Image& reference,
                                        const CompareOptions& options) {
  const ImagePair pair = PairImages(got, reference, options);
  std::vector<LayerMetrics> metrics;
  for (const LayerPair& layer : pair.layers) metrics.push_back(CompareLayer(pair, layer));
  return metrics;
}

}  // namespace nacre
