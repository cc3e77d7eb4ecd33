// SPDX-License-Identifier: Apache-2.0
// render/adaptive.h: adaptive sampling: every block of 4x4 pixels takes samples until its error is
// small enough.
//
// Blocks lie on a grid of the whole frame and are evaluated whole, so that a block's pixels never
// depend on crops, strips or threads. A block whose footprint lies on one smooth hit, or beside
// everything, stops at its pixels' centres (footprint.h). The others take the common levels; then a
// block stops as a whole, or its pixels one by one, where in each channel the half-width of the 95
// % confidence interval from the spread of four independent scramblings (Student's t with three
// degrees of freedom) is below the wanted error times |L|, of 0.05 at least and of white's at
// most (white_level.h), no neighbour in the block is far from that (convergence.h), and there is
// evidence enough that nothing rare was missed (evidence.h).
//
// Most of the error of a picture of spheres is in the pixels on their outlines, where samples tell
// how much of the pixel is covered. Of a pixel that one outline crosses before the background this
// is known (outline_coverage.h), and samples need only tell what the covered part looks like.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "render/interval.h"
#include "render/interval_kernel.h"
#include "render/sphere_pictures.h"
#include "render/tile.h"
#include "render/tile_layers.h"

namespace nacre {

// Blocks are taken together by cells of the intersector's bins.
inline constexpr int kCellSide = kCellSize;
inline constexpr size_t kCellBlocks =
    size_t{kCellSide / kBlockSide} * size_t{kCellSide / kBlockSide};
inline constexpr size_t kCellPixels = kCellBlocks * kBlockPixels;

// Pixels are numbered block by block, row by row within a block.
struct CellScratch {
  // Samples of one replicate of one pixel.
  struct Unit {
    uint32_t pixel;
    uint32_t replicate;
  };

  std::vector<uint32_t> active;   // pixels that need more samples
  uint32_t samples[kCellPixels];  // of each pixel in each replicate; 0: its centre
  // Sums of the samples in each replicate: of the beauty, and of coverage (kAlphaSum).
  double replicate[kReplicates][4][kCellPixels];
  BlockIntervals intervals[kCellBlocks];               // of blocks with active pixels
  std::optional<std::vector<SpherePicture>> pictures;  // of the cell's spheres, unless too many
  uint32_t outlines_only;             // blocks, as bits, whose only edges are outlines of spheres
  uint32_t outlined;                  // blocks, as bits, with such pixels:
  bool on_outline[kCellPixels];       // a sphere's outline crosses the pixel
  bool sees_background[kCellPixels];  // of these: no sphere covers all of the pixel
  double covered[kCellPixels];  // the share that the sphere covers, or -1 where it is not known
  // The range of a pixel's samples that hit, if they were added by whole blocks; and that of all of
  // them on the outlines of a block.
  double low[3][kCellPixels], high[3][kCellPixels];
  PixelRange outline_range[3][kCellBlocks];
  // The two least and the two greatest of all samples of a pixel, misses too (evidence.h).
  double low1[3][kCellPixels], low2[3][kCellPixels];
  double high2[3][kCellPixels], high1[3][kCellPixels];
  // What few samples find of a pixel (rare_features.h): how many find it, and at most how much of
  // the pixel's radiance it is.
  double rare_samples[kCellPixels], rare_radiance[kCellPixels];
  // Pixels whose covered share is known, and a place on the film in each that hits.
  struct SoughtHit {
    uint32_t pixel;
    double x, y;
  };
  std::vector<SoughtHit> sought;
  std::vector<double> hits = std::vector<double>(kBatchCapacity);  // 1 for rays that hit, else 0
  std::vector<SampledPixel> pixels;
  std::vector<Unit> units = std::vector<Unit>(kBatchCapacity);  // room for those of a batch
  PixelBatch block{kBlockPixels};
  FilmBatch corners;
};

// The window of a cell's block.
inline Window BlockWindow(const Window& cell, size_t block) {
  constexpr size_t kAcross = kCellSide / kBlockSide;
  const int x = cell.x0 + static_cast<int>(block % kAcross) * kBlockSide;
  const int y = cell.y0 + static_cast<int>(block / kAcross) * kBlockSide;
  return {x, y, x + kBlockSide, y + kBlockSide};
}

inline FilmPixel PixelOf(const Window& cell, uint32_t pixel) {
  const Window block = BlockWindow(cell, pixel / kBlockPixels);
  const auto in_block = static_cast<int>(pixel % kBlockPixels);
  return {pixel, block.x0 + in_block % kBlockSide, block.y0 + in_block / kBlockSide};
}

// Numbers for samples that stand alone, not in a pattern.
inline void NumberAlike(size_t count, SampleNumbers* numbers) {
  std::fill_n(numbers->number.data(), count, 0u);
  std::fill_n(numbers->pixel.data(), count, 0u);
  numbers->pixel_count = 1;
  numbers->seeds[0] = 0;
}

// Renders the pixels of `part` of a cell of the frame into the strip.
void RenderCell(const RenderPlan& plan, const Window& cell, const Window& part,
                TileScratch* scratch, CellScratch* cell_scratch, Strip* strip, StageClock* clock,
                RenderStats* stats);

}  // namespace nacre
