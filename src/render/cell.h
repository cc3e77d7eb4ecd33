// SPDX-License-Identifier: Apache-2.0
// render/cell.h: the cells of adaptive sampling (adaptive.h), their blocks and their pixels.
#pragma once

#include <optional>
#include <vector>

#include "render/interval.h"
#include "render/sphere_projections.h"
#include "render/tile_work.h"
#include "visibility/sphere_bins.h"

namespace nacre {

inline constexpr int kBlockSide = 4;
inline constexpr size_t kBlockPixels = size_t{kBlockSide} * kBlockSide;
// The blocks of one cell of the intersector's bins (kCellSize).
inline constexpr size_t kCellBlocks =
    size_t{kCellSize / kBlockSide} * size_t{kCellSize / kBlockSide};
inline constexpr size_t kCellPixels = kCellBlocks * kBlockPixels;

// The confidence intervals of a cell's pixels. These are numbered block by block, and row by row
// within a block.
struct CellIntervals {
  bool narrow[kCellPixels];        // the half-width is within the tolerance in every channel
  double half_width[kCellPixels];  // largest of the channels
  double tolerance[kCellPixels];   // smallest of the channels
};

// A pixel to sample by the pattern of one replicate.
struct SampleEntry {
  uint32_t pixel;
  uint32_t replicate;
};

// The projections of the spheres that rays of the cell may hit; nullopt if they are too many.
using CellProjections = std::optional<std::vector<SphereProjection>>;

// The window of a cell's block.
inline Window BlockWindow(const Window& cell, size_t block) {
  constexpr size_t kAcross = kCellSize / kBlockSide;
  const int x = cell.x0 + static_cast<int>(block % kAcross) * kBlockSide;
  const int y = cell.y0 + static_cast<int>(block / kAcross) * kBlockSide;
  return {x, y, x + kBlockSide, y + kBlockSide};
}

// Calls work(block) for each block whose bit is set.
template <class Work>
void ForEachBlock(uint32_t blocks, const Work& work) {
  for (; blocks != 0; blocks &= blocks - 1) work(static_cast<size_t>(__builtin_ctz(blocks)));
}

inline FilmPixel PixelOf(const Window& cell, uint32_t pixel) {
  const Window block = BlockWindow(cell, pixel / kBlockPixels);
  const auto in_block = static_cast<int>(pixel % kBlockPixels);
  return {pixel, block.x0 + in_block % kBlockSide, block.y0 + in_block / kBlockSide};
}

// The number of the pixel in this column and row of a cell.
inline uint32_t PixelAt(int column, int row) {
  constexpr int kAcross = kCellSize / kBlockSide;
  const int block = row / kBlockSide * kAcross + column / kBlockSide;
  const int in_block = row % kBlockSide * kBlockSide + column % kBlockSide;
  return static_cast<uint32_t>(block * static_cast<int>(kBlockPixels) + in_block);
}

}  // namespace nacre
