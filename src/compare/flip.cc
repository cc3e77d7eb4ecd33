// SPDX-License-Identifier: Apache-2.0
#include "compare/flip.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "base/aligned.h"
#include "base/parallel.h"
#include "color/display.h"
#include "color/luminance.h"
#include "compare/flip_rows.h"

namespace nacre {
namespace {

constexpr int kColumns = static_cast<int>(kFlipColumns);
constexpr int kBlockRows = static_cast<int>(kFlipBlockRows);
// Rows of a tile. Its samples stay in L2 for all exposures, and the filters read only a sixth as
// many rows beyond it.
constexpr int kTileRows = 128;

struct Tile {
  int x0, y0, y1;
};

// Computes FLIP of one tile, from the top down. Filtered rows of both pictures are kept in a ring
// for as long as later blocks need them.
class TileWork {
 public:
  TileWork(const PictureView& reference, const PictureView& test, const FlipWeights& weights,
           const Tile& tile)
      : reference_(reference),
        test_(test),
        weights_(weights),
        tile_(tile),
        radius_(static_cast<int>(weights.radius)),
        line_(FlipLineRoom(weights.radius)),
        slots_(2 * weights.radius + kFlipBlockRows),
        light_(3 * line_),
        ring_(2 * slots_ * kFlipRow),
        block_(kFlipScratch + kFlipBlockRows * kFlipColumns) {
    for (std::vector<const float*>& rows : rows_) rows.resize(slots_);
    CountUnequalRows();
  }

  // Raises the tile's pixels in the map to FLIP where that is larger.
  void Raise(const ShowPair& show, Plane* map) {
    next_ = 0;
    for (int y = tile_.y0; y < tile_.y1; y += kBlockRows) {
      const int top = std::max(y - radius_, 0);
      const int end = std::min(y + kBlockRows + radius_, reference_.height);
      if (show.alike && UnequalRows(top, end) == 0) continue;
      for (int row = std::max(top, next_); row < end; ++row) FilterRow(show, row);
      next_ = end;
      for (size_t i = 0; i < slots_; ++i) {
        const int row = std::clamp(y - radius_ + static_cast<int>(i), 0, reference_.height - 1);
        rows_[0][i] = Slot(0, row);
        rows_[1][i] = Slot(1, row);
      }
      float* const flip = block_.data() + kFlipScratch;
      FlipBlock(weights_, rows_[0].data(), rows_[1].data(), block_.data(), flip);
      const int width = std::min(kColumns, map->width - tile_.x0);
      for (int row = y; row < std::min(y + kBlockRows, tile_.y1); ++row) {
        const float* const from = flip + (row - y) * kColumns;
        float* const to = &map->at(tile_.x0, row);
        for (int x = 0; x < width; ++x) to[x] = std::max(to[x], from[x]);
      }
    }
  }

 private:
  // The number of rows in [first, end) whose samples, in all columns that the filters read, differ
  // in any bit between the pictures.
  int UnequalRows(int first, int end) const {
    return unequal_[static_cast<size_t>(end - unequal_first_)] -
           unequal_[static_cast<size_t>(first - unequal_first_)];
  }

  void CountUnequalRows() {
    unequal_first_ = std::max(tile_.y0 - radius_, 0);
    const int end = std::min(tile_.y1 + kBlockRows + radius_, reference_.height);
    const int x0 = std::max(tile_.x0 - radius_, 0);
    const int x1 = std::min(tile_.x0 + kColumns + radius_, reference_.width);
    const size_t bytes = static_cast<size_t>(x1 - x0) * sizeof(float);
    unequal_.push_back(0);
    for (int y = unequal_first_; y < end; ++y) {
      bool unequal = false;
      for (size_t c = 0; c < 3 && !unequal; ++c) {
        const auto row = static_cast<size_t>(y);
        unequal = std::memcmp(reference_.rgb[c] + row * reference_.stride + x0,
                              test_.rgb[c] + row * test_.stride + x0, bytes) != 0;
      }
      unequal_.push_back(unequal_.back() + (unequal ? 1 : 0));
    }
  }

  float* Slot(size_t picture, int row) {
    const size_t slot = static_cast<size_t>(row) % slots_;
    return ring_.data() + (picture * slots_ + slot) * kFlipRow;
  }

  void FilterRow(const ShowPair& show, int row) {
    const std::array<float*, 3> light = {light_.data(), light_.data() + line_,
                                         light_.data() + 2 * line_};
    const int count = kColumns + 2 * radius_;
    ReadLight(reference_, show.reference, tile_.x0 - radius_, row, count, light);
    FilterFlipRow(weights_, light, Slot(0, row));
    ReadLight(test_, show.test, tile_.x0 - radius_, row, count, light);
    FilterFlipRow(weights_, light, Slot(1, row));
  }

  const PictureView& reference_;
  const PictureView& test_;
  const FlipWeights& weights_;
  Tile tile_;
  int radius_;
  size_t line_, slots_;
  AlignedArray<float> light_, ring_, block_;
  std::vector<const float*> rows_[2];
  int next_ = 0;  // the first row that is not filtered yet
  std::vector<int> unequal_;
  int unequal_first_ = 0;
};

}  // namespace

Plane FlipMap(const PictureView& reference, const PictureView& test,
              std::span<const ShowPair> shows, double pixels_per_degree) {
  const FlipWeights weights = MakeFlipWeights(pixels_per_degree);
  std::vector<Tile> tiles;
  for (int y = 0; y < reference.height; y += kTileRows) {
    for (int x = 0; x < reference.width; x += kColumns) {
      tiles.push_back({x, y, std::min(y + kTileRows, reference.height)});
    }
  }
  Plane map(reference.width, reference.height);
  ParallelFor(tiles.size(), 0, [&](size_t i) {
    TileWork work(reference, test, weights, tiles[i]);
    for (const ShowPair& show : shows) work.Raise(show, &map);
  });
  return map;
}

// ---- Linear pictures over a range of exposures --------------------------------------------------

namespace {

// The pre-exposure that Narkowicz cancels in his text; with it, curve(1) is 0.8.
constexpr double kPreExposure = 0.6;
constexpr double kShown = 0.85;  // of white; for t_max and t_min

// The radiance that the tone curve maps to `light`: the positive root of its quadratic.
double RadianceShownAs(double light) {
  const double a = 2.51 - 2.43 * light;
  const double b = 0.03 - 0.59 * light;
  const double c = -0.14 * light;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a) / kPreExposure;
}

double Median(std::vector<double>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  if (values->size() % 2 == 1) return *middle;
  return (*std::max_element(values->begin(), middle) + *middle) / 2;
}

ShowPair ShowAt(double exposure) {
  // Limited to float's range, which references that consist of denormals would exceed.
  const double stops = std::clamp(exposure + std::log2(kPreExposure), -126.0, 127.0);
  const DisplaySettings display{.tone = ToneOperator::kAces, .exposure_ev = stops};
  const ShowFunction show = [display](size_t count, float* r, float* g, float* b) {
    ShowLight(display, count, r, g, b);
  };
  return {show, show, /*alike=*/true};
}

}  // namespace

ExposureRange FlipExposures(const PictureView& reference) {
  std::vector<double> luminances;
  luminances.reserve(static_cast<size_t>(reference.width) * static_cast<size_t>(reference.height));
  for (int y = 0; y < reference.height; ++y) {
    const size_t row = static_cast<size_t>(y) * reference.stride;
    for (size_t i = row; i < row + static_cast<size_t>(reference.width); ++i) {
      const auto at = [&](size_t c) { return std::max(double{reference.rgb[c][i]}, 0.0); };
      luminances.push_back(Luminance<double>({at(0), at(1), at(2)}));
    }
  }
  const double brightest = *std::max_element(luminances.begin(), luminances.end());
  if (brightest == 0) return {};
  double median = Median(&luminances);
  if (median == 0) {
    std::erase(luminances, 0.0);
    median = Median(&luminances);
  }
  const double radiance = RadianceShownAs(kShown);
  const double start = std::log2(radiance / brightest), stop = std::log2(radiance / median);
  return {start, stop, std::max(2, static_cast<int>(std::ceil(stop - start)))};
}

Plane HdrFlipMap(const PictureView& reference, const PictureView& test, const ExposureRange& range,
                 double pixels_per_degree) {
  const double step = range.count > 1 ? (range.stop - range.start) / (range.count - 1) : 0;
  std::vector<ShowPair> shows;
  for (int i = 0; i < range.count; ++i) shows.push_back(ShowAt(range.start + i * step));
  return FlipMap(reference, test, shows, pixels_per_degree);
}

}  // namespace nacre
