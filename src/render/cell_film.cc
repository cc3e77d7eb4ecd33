// SPDX-License-Identifier: Apache-2.0
#include "render/cell_film.h"

namespace nacre {
namespace {

// Rows of blocks into rows of the strip, as far as they lie in `part`: convert(i) is the cell's
// pixel i.
template <typename T, typename Convert>
void PutCell(const Window& cell, const Window& part, const Strip& strip, AlignedArray<T>* to,
             const Convert& convert) {
  for (size_t b = 0; b < kCellBlocks; ++b) {
    const Window block = BlockWindow(cell, b);
    const Window shown = Intersect(block, part);
    for (int y = shown.y0; y < shown.y1; ++y) {
      const size_t row = b * kBlockPixels + static_cast<size_t>(y - block.y0) * kBlockSide;
      T* const out = to->data() + static_cast<size_t>(y - strip.window.y0) *
                                      static_cast<size_t>(strip.window.width());
      for (int x = shown.x0; x < shown.x1; ++x) {
        out[x - strip.window.x0] = convert(row + static_cast<size_t>(x - block.x0));
      }
    }
  }
}

}  // namespace

void AddReplicates(const CellScratch& c, TileFilm* film) {
  for (size_t channel = 0; channel < 3; ++channel) {
    double* const sums = film->sums[channel].data();
    for (const auto& replicate : c.replicate) {
      for (size_t i = 0; i < kCellPixels; ++i) sums[i] += replicate[channel][i];
    }
  }
}

void ResolveCell(const RenderPlan& plan, const Window& cell, const Window& part,
                 const TileFilm& film, const CellScratch& c, Strip* strip) {
  double scale[kCellPixels];
  for (size_t i = 0; i < kCellPixels; ++i) {
    scale[i] = c.samples[i] == 0 ? 1 : 1 / (double{kReplicates} * c.samples[i]);
  }
  size_t sum = 0, nearest = 0, id = 0, color = 0;
  for (const ChannelKind kind : plan.channels) {
    if (kind == ChannelKind::kAveraged) {
      const double* const sums = film.sums[sum++].data();
      PutCell(cell, part, *strip, &strip->colors[color++],
              [&](size_t i) { return static_cast<float>(sums[i] * scale[i]); });
    } else if (kind == ChannelKind::kNearest) {
      const float* const values = film.nearest[nearest++].data();
      PutCell(cell, part, *strip, &strip->colors[color++], [&](size_t i) { return values[i]; });
    } else {
      const uint32_t* const values = film.ids[id].data();
      PutCell(cell, part, *strip, &strip->ids[id++], [&](size_t i) { return values[i]; });
    }
  }
}

}  // namespace nacre
