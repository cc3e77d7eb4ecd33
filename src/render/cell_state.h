// SPDX-License-Identifier: Apache-2.0
// render/cell_state.h: what adaptive sampling (adaptive.h) knows about the pixels of one cell.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "render/interval.h"
#include "render/interval_kernel.h"
#include "render/sphere_projections.h"
#include "render/tile_work.h"
#include "visibility/sphere_bins.h"

namespace nacre {

// The blocks of one cell of the intersector's bins (kCellSize).
inline constexpr size_t kCellBlocks =
    size_t{kCellSize / kBlockSide} * size_t{kCellSize / kBlockSide};
inline constexpr size_t kCellPixels = kCellBlocks * kBlockPixels;

// Pixels are numbered block by block, and row by row within a block.
struct CellState {
  // A pixel to sample by the pattern of one replicate.
  struct SampleEntry {
    uint32_t pixel;
    uint32_t replicate;
  };

  std::vector<uint32_t> active;   // pixels that need more samples
  uint32_t samples[kCellPixels];  // of each pixel in each replicate; 0: only its centre
  // Sums of the samples of each replicate: the three channels of the beauty, and coverage.
  double replicate[kReplicates][4][kCellPixels];
  BlockIntervals intervals[kCellBlocks];  // of blocks with active pixels
  // The projections of the spheres that rays of the cell may hit; nullopt if they are too many.
  std::optional<std::vector<SphereProjection>> projections;
  uint32_t only_outlines;             // blocks, as bits, whose only edges are outlines of spheres
  uint32_t outlined;                  // blocks, as bits, that have pixels with on_outline
  bool on_outline[kCellPixels];       // the outline of a sphere may cross the pixel
  bool sees_background[kCellPixels];  // where on_outline: no sphere covers the whole pixel
  double coverage[kCellPixels];       // the pixel's coverage in [0, 1], or -1 if it is not known
  // The range of those samples of a pixel that hit and were taken by whole blocks, and its union
  // over the pixels of a block that lie on outlines.
  double hit_low[3][kCellPixels], hit_high[3][kCellPixels];
  PixelRange outline_range[3][kCellBlocks];
  // The two least and the two greatest of all samples of a pixel, misses included (evidence.h).
  double lowest[3][kCellPixels], second_lowest[3][kCellPixels];
  double second_highest[3][kCellPixels], highest[3][kCellPixels];
  // Rare features of a pixel, which few of its samples hit (rare_features.h): how many samples are
  // needed to hit them, and an upper bound of what they add to the pixel's radiance.
  double rare_samples[kCellPixels], rare_radiance[kCellPixels];
  // A rare feature of a pixel whose radiance is known: triangles of one material
  // (rare_triangles.h), or texels that look alike (rare_texels.h). Sorted by pixel.
  struct RarePart {
    uint32_t pixel;
    double share;  // of the pixel's samples that hit it
    Rgb radiance;  // what it adds to the pixel, that is, its radiance times the share
  };
  std::vector<RarePart> rare_parts;
  bool has_other_texels[kCellPixels];  // texels that matter and are not in rare_parts
  // How many samples a pixel needs to find the rare features that matter, judged by its samples so
  // far (evidence.h); 0 if none do.
  double required_samples[kCellPixels];
  // A point on the film, in pixels, whose ray hits the sphere that partly covers the pixel.
  struct CoveredPoint {
    uint32_t pixel;
    double x, y;
  };
  std::vector<CoveredPoint> covered_points;  // one for each pixel whose coverage is known
  // The part of the pixel that its samples are spread over: 1, or the area of the patches that hold
  // its dust, as shares of the pixel (dust.h).
  double sampled_share[kCellPixels];
  // A parallelogram on the film, in pixels, or the half of it at its corner.
  struct DustPatch {
    Vec2d corner, sides[2];
    bool triangle;
    double area;
  };
  bool has_dust;                   // whether pixels have patches
  std::vector<DustPatch> patches;  // by pixel; valid if has_dust
  uint32_t first_patch[kCellPixels + 1];
  // Buffers.
  std::vector<double> hits = std::vector<double>(kBatchCapacity);  // 1 for rays that hit, else 0
  std::vector<double> sample_share = std::vector<double>(kBatchCapacity);  // of dust samples
  std::vector<SampledPixel> pixels;
  std::vector<SampleEntry> sample_list = std::vector<SampleEntry>(kBatchCapacity);  // of a batch
  PixelBatch block{kBlockPixels};
  FilmBatch corners;  // of footprints
  CameraHits corner_hits;
};

// The patches that the samples of a pixel are spread over; none for most pixels.
inline std::span<const CellState::DustPatch> PatchesOf(const CellState& c, uint32_t pixel) {
  if (!c.has_dust) return {};
  const uint32_t first = c.first_patch[pixel];
  return {c.patches.data() + first, c.first_patch[pixel + 1] - first};
}

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

// The number of the pixel in this column and row of a cell.
inline uint32_t PixelAt(int column, int row) {
  constexpr int kAcross = kCellSize / kBlockSide;
  const int block = row / kBlockSide * kAcross + column / kBlockSide;
  const int in_block = row % kBlockSide * kBlockSide + column % kBlockSide;
  return static_cast<uint32_t>(block * static_cast<int>(kBlockPixels) + in_block);
}

// Gives the same number to samples that belong to no pixel's pattern.
inline void NumberAlike(size_t count, SampleNumbers* numbers) {
  std::fill_n(numbers->number.data(), count, 0u);
  std::fill_n(numbers->pixel.data(), count, 0u);
  numbers->pixel_count = 1;
  numbers->seeds[0] = 0;
}

}  // namespace nacre
