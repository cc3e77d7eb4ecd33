// SPDX-License-Identifier: Apache-2.0
// render/adaptive.h: adaptive sampling: every block of 4x4 pixels takes samples until its error is
// small enough.
//
// Blocks lie on a grid of the whole frame and are evaluated whole, so that a block's pixels never
// depend on crops, strips or threads. A block whose footprint lies on one smooth hit, or beside
// everything, stops at its pixels' centres (footprint.h). The others take the common levels; then a
// block stops as a whole, or its pixels one by one, where in each channel the half-width of the 95
// % confidence interval from the spread of four independent scramblings (Student's t with three
// degrees of freedom) is below the wanted error times max(|L|, 0.05), and no neighbour in the block
// is far from that.
#pragma once

#include "render/tile.h"

namespace nacre {

inline constexpr int kBlockSide = 4;
inline constexpr size_t kBlockPixels = size_t{kBlockSide} * kBlockSide;
// Blocks are taken together by cells of the intersector's bins.
inline constexpr int kCellSide = kCellSize;
inline constexpr size_t kCellBlocks =
    size_t{kCellSide / kBlockSide} * size_t{kCellSide / kBlockSide};
inline constexpr size_t kCellPixels = kCellBlocks * kBlockPixels;

// Below this value an error is absolute: what a display shows as near black.
inline constexpr double kDarkest = 0.05;

// What is known of a pixel's error.
struct PixelInterval {
  bool narrow = false;    // its interval is as narrow as wanted, in every channel
  double half_width = 0;  // of its widest channel
  double wanted = 0;      // of its strictest
};

// Pixels are numbered block by block, row by row within a block.
struct CellScratch {
  // Samples of one replicate of one pixel.
  struct Unit {
    uint32_t pixel;
    uint32_t replicate;
  };

  std::vector<uint32_t> active;   // pixels that need more samples
  uint32_t samples[kCellPixels];  // of each pixel in each replicate; 0: its centre
  // Sums of the beauty's samples in each replicate.
  double replicate[kReplicates][3][kCellPixels];
  PixelInterval intervals[kCellPixels];
  std::vector<SampledPixel> pixels;
  std::vector<Unit> units = std::vector<Unit>(kBatchCapacity);  // room for those of a batch
  PixelShifts shifts{kBlockPixels + kBatchPadding};
  FilmBatch corners;
};

// The window of a cell's block.
inline Window BlockWindow(const Window& cell, size_t block) {
  constexpr size_t kAcross = kCellSide / kBlockSide;
  const int x = cell.x0 + static_cast<int>(block % kAcross) * kBlockSide;
  const int y = cell.y0 + static_cast<int>(block / kAcross) * kBlockSide;
  return {x, y, x + kBlockSide, y + kBlockSide};
}

// Renders the pixels of `part` of a cell of the frame into the strip.
void RenderCell(const RenderPlan& plan, const Window& cell, const Window& part,
                TileScratch* scratch, CellScratch* cell_scratch, Strip* strip, RenderStats* stats);

}  // namespace nacre
