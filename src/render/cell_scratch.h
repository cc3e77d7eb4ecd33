// SPDX-License-Identifier: Apache-2.0
// render/cell_scratch.h: what adaptive sampling (adaptive.h) knows of the pixels of one cell.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "render/interval.h"
#include "render/interval_kernel.h"
#include "render/sphere_pictures.h"
#include "render/tile_work.h"
#include "visibility/sphere_bins.h"

namespace nacre {

// Blocks are grouped by the cells of the intersector's bins (kCellSize).
inline constexpr size_t kCellBlocks =
    size_t{kCellSize / kBlockSide} * size_t{kCellSize / kBlockSide};
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
  // The same of triangles of one material (rare_triangles.h), whose radiance is known: pixel by
  // pixel.
  struct RareTriangles {
    uint32_t pixel;
    double share;  // of the pixel's samples, that hit them
    Rgb radiance;  // what they add to the pixel's: times that share
  };
  std::vector<RareTriangles> rare_triangles;
  // What comes of both where it matters for the pixel as it looks now (evidence.h): how many
  // samples it must have; 0 where nothing that is rare does.
  double known_rare[kCellPixels];
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
  FilmBatch corners;  // of footprints
  CameraHits corner_hits;
};

// The window of a cell's block.
inline Window BlockWindow(const Window& cell, size_t block) {
  constexpr size_t kAcross = kCellSize / kBlockSide;
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

}  // namespace nacre
