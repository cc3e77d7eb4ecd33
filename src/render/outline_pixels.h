// SPDX-License-Identifier: Apache-2.0
// render/outline_pixels.h: the pixels of a cell that outlines of spheres may cross.
#pragma once

#include <span>
#include <vector>

#include "render/cell.h"
#include "render/dust.h"
#include "render/sphere_projections.h"

namespace nacre {

struct OutlinePixels {
  uint32_t blocks;                    // as bits, that have pixels with on_outline
  bool on_outline[kCellPixels];       // the outline of a sphere may cross the pixel
  bool sees_background[kCellPixels];  // where on_outline: no sphere covers the whole pixel
  double coverage[kCellPixels];       // the pixel's coverage in [0, 1], or -1 if it is not known
  // A point on the film, in pixels, whose ray hits the sphere that partly covers the pixel.
  struct CoveredPoint {
    uint32_t pixel;
    double x, y;
  };
  std::vector<CoveredPoint> covered_points;  // one for each pixel whose coverage is known
  // The range of those samples of a pixel that hit and were taken by whole blocks, and its union
  // over the pixels of a block that lie on outlines.
  double hit_low[3][kCellPixels], hit_high[3][kCellPixels];
  PixelRange hit_range[3][kCellBlocks];
};

inline bool HasOutlines(const OutlinePixels& outlines, size_t block) {
  return (outlines.blocks >> block & 1) != 0;
}

// Before the first sample: finds those of the pixels that outlines may cross, and the coverage of
// those that show a single outline in front of the background.
void FindOutlinePixels(const FramePlan& plan, const Window& cell, std::span<const uint32_t> pixels,
                       const CellProjections& projections, const CellDust& dust,
                       OutlinePixels* outlines);

// Sets hit_range, from `pixels`.
void FindHitRanges(std::span<const uint32_t> pixels, OutlinePixels* outlines);

}  // namespace nacre
