// SPDX-License-Identifier: Apache-2.0
#include "compare/metrics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace nacre {
namespace {

// Running sums over the samples of a layer.
class Accumulator {
 public:
  // `samples`: as many as there will be.
  Accumulator(std::string layer, size_t samples) : kept_(samples - RankOf999(samples)) {
    metrics_.layer = std::move(layer);
    largest_relative_.reserve(kept_);
  }

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
    const double softened = SoftenedError(error, reference);
    squares_ += error * error;
    softened_squares_ += softened * softened;
    sum_got_ += got;
    sum_reference_ += reference;
    metrics_.max_abs = std::max(metrics_.max_abs, error);
    metrics_.psnr_peak = std::max(metrics_.psnr_peak, std::abs(static_cast<double>(reference)));
    AddRelative(error, reference);
  }

  LayerMetrics Finish() {
    if (finite_ == 0) return metrics_;
    const auto count = static_cast<double>(finite_);
    metrics_.rmse = std::sqrt(squares_ / count);
    metrics_.rel_mse = softened_squares_ / count;
    if (metrics_.rmse > 0) {
      metrics_.psnr_db = 20 * std::log10(metrics_.psnr_peak / metrics_.rmse);
    }
    metrics_.mean_got = sum_got_ / count;
    metrics_.mean_reference = sum_reference_ / count;
    if (relative_count_ > 0) {
      // Ascending. Of fewer samples fewer are above the rank.
      std::sort_heap(largest_relative_.begin(), largest_relative_.end(), std::greater<>());
      std::reverse(largest_relative_.begin(), largest_relative_.end());
      const size_t above = relative_count_ - RankOf999(relative_count_);
      metrics_.p999_rel = largest_relative_[largest_relative_.size() - above];
    }
    return metrics_;
  }

 private:
  // The index, in ascending order, of the value that 99.9 % of `count` values do not exceed.
  static size_t RankOf999(size_t count) {
    return count == 0 ? 0 : static_cast<size_t>(std::ceil(0.999 * static_cast<double>(count))) - 1;
  }

  void AddRelative(double error, float reference) {
    if (reference == 0) {
      metrics_.zero_mismatches += error > 0;
      return;
    }
    ++relative_count_;
    const double relative = RelativeError(error, reference);
    metrics_.max_rel = std::max(metrics_.max_rel, relative);
    // Kept as floats, of which there may be thousands; references may be denormals.
    constexpr double kMost = std::numeric_limits<float>::max();
    Keep(static_cast<float>(std::min(relative, kMost)));
  }

  // A heap with the smallest of the kept errors on top: one in a thousand is kept, not all, which
  // would take as much memory as an image.
  void Keep(float relative) {
    if (largest_relative_.size() == kept_) {
      if (relative <= largest_relative_.front()) return;
      std::pop_heap(largest_relative_.begin(), largest_relative_.end(), std::greater<>());
      largest_relative_.pop_back();
    }
    largest_relative_.push_back(relative);
    std::push_heap(largest_relative_.begin(), largest_relative_.end(), std::greater<>());
  }

  LayerMetrics metrics_;
  size_t finite_ = 0;
  double largest_ = 0;
  double squares_ = 0, softened_squares_ = 0, sum_got_ = 0, sum_reference_ = 0;
  size_t kept_, relative_count_ = 0;
  std::vector<float> largest_relative_;
};

}  // namespace

LayerMetrics CompareLayer(const ImagePair& pair, const LayerPair& layer) {
  const Window& window = pair.window;
  Accumulator accumulator(layer.layer, layer.channels.size() * window.pixel_count());
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

}  // namespace nacre
