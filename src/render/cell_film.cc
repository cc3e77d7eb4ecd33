// SPDX-License-Identifier: Apache-2.0
#include "render/cell_film.h"

#include <algorithm>

namespace nacre {
namespace {

// Copies the cell's pixels that lie in `part` from block order to rows of the strip.
template <typename T>
void CopyCell(const Window& cell, const Window& part, const Strip& strip, const T* values,
              std::span<T> to) {
  const auto stride = static_cast<size_t>(strip.window.width());
  for (size_t b = 0; b < kCellBlocks; ++b, values += kBlockPixels) {
    const Window block = BlockWindow(cell, b);
    const Window shown = Intersect(block, part);
    if (shown.empty()) continue;
    const T* from = values + (shown.y0 - block.y0) * kBlockSide + (shown.x0 - block.x0);
    T* row = to.data() + static_cast<size_t>(shown.y0 - strip.window.y0) * stride +
             static_cast<size_t>(shown.x0 - strip.window.x0);
    for (int y = shown.y0; y < shown.y1; ++y, from += kBlockSide, row += stride) {
      std::copy_n(from, shown.width(), row);
    }
  }
}

}  // namespace

void ClearReplicates(uint32_t blocks, CellSamples* samples) {
  ForEachBlock(blocks, [&](size_t block) {
    const size_t first = block * kBlockPixels;
    for (auto& replicate : samples->sums) {
      for (auto& channel : replicate) std::fill_n(channel + first, kBlockPixels, 0.0);
    }
  });
}

void AddReplicates(uint32_t blocks, const CellSamples& samples, TileFilm* film) {
  ForEachBlock(blocks, [&](size_t block) {
    const size_t first = block * kBlockPixels;
    for (size_t channel = 0; channel < 4; ++channel) {
      double* const sums = film->sums[channel].data() + first;
      for (const auto& replicate : samples.sums) {
        for (size_t i = 0; i < kBlockPixels; ++i) sums[i] += replicate[channel][first + i];
      }
    }
  });
}

PixelSampleCounts CountSamples(const Window& cell, const Window& part, const CellSamples& samples) {
  PixelSampleCounts counts;
  for (uint32_t i = 0; i < kCellPixels; ++i) {
    const FilmPixel at = PixelOf(cell, i);
    if (Intersect({at.x, at.y, at.x + 1, at.y + 1}, part).empty()) continue;
    counts.Add(std::max(1u, kReplicates * samples.count[i]), 1);  // at least the centre
  }
  return counts;
}

// A pixel of coverage s is s times the mean of its hits plus (1 - s) times the background. If h of
// its n samples hit, their sum holds the background n - h times, so the pixel is s / h times the
// sum plus 1 - s n / h times the background. Other pixels are the mean of all samples.
void ResolveCell(const FramePlan& plan, const Window& cell, const Window& part,
                 const TileFilm& film, const CellSamples& samples, const OutlinePixels& outlines,
                 Strip* strip) {
  double of_sum[kCellPixels], of_background[kCellPixels];
  const double* const hits = film.sums[kAlphaSum].data();
  for (size_t i = 0; i < kCellPixels; ++i) {
    const double count = double{kReplicates} * samples.count[i];
    of_sum[i] = samples.count[i] == 0 ? 1 : 1 / count;
    of_background[i] = 0;
    if (samples.count[i] == 0 || outlines.coverage[i] < 0) continue;
    of_sum[i] = hits[i] > 0 ? outlines.coverage[i] / hits[i] : 0;
    of_background[i] = 1 - of_sum[i] * count;
  }
  size_t sum = 0, nearest = 0, id = 0, color = 0;
  for (const auto& [kind, background] : plan.film.channels) {
    if (kind == ChannelKind::kAveraged) {
      const double* const sums = film.sums[sum++].data();
      float values[kCellPixels];
      for (size_t i = 0; i < kCellPixels; ++i) {
        values[i] = static_cast<float>(sums[i] * of_sum[i] + background * of_background[i]);
      }
      CopyCell(cell, part, *strip, values, strip->colors[color++]);
    } else if (kind == ChannelKind::kNearest) {
      CopyCell(cell, part, *strip, film.nearest[nearest++].data(), strip->colors[color++]);
    } else {
      CopyCell(cell, part, *strip, film.ids[id].data(), strip->ids[id]);
      ++id;
    }
  }
}

}  // namespace nacre
