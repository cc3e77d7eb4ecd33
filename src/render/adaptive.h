// SPDX-License-Identifier: Apache-2.0
// render/adaptive.h: adaptive sampling: every block of 4x4 pixels takes samples until the estimated
// error of its pixels is small enough.
//
// Blocks lie on a grid of the whole frame and are evaluated whole, so that a block's pixels never
// depend on the region, strips or threads. A block stops at one sample per pixel, through the
// centre, if it lies on one sphere that varies smoothly there, or beside all shapes (footprint.h).
// The others take the common levels. Then a block stops as a whole, or its pixels stop one by one,
// when
// - in each channel the half-width of the 95 % confidence interval of the mean is below the
//   tolerance. The interval comes from the spread of four independently scrambled replicates of the
//   sample pattern, by Student's t with three degrees of freedom. The tolerance is max_error times
//   |L|, where |L| is clamped to at least 0.05 and at most white (white_level.h);
// - no neighbour in the block is far from its tolerance (convergence.h);
// - there are enough samples to rule out that something rare was missed (evidence.h).
//
// In pictures of spheres most of the error is in the pixels on outlines, where the share of samples
// that hit estimates how much of the pixel is covered. Where a pixel shows one outline in front of
// the background, this coverage is computed exactly (outline_coverage.h), and samples need only
// estimate the radiance of the covered part.
#pragma once

#include <vector>

#include "render/evidence.h"

namespace nacre {

// What one worker knows about a cell, and its buffers, reused from cell to cell.
struct CellRoom {
  CellState state;
  // Of the samples of one batch.
  std::vector<double> hits = std::vector<double>(kBatchCapacity);  // 1 for rays that hit, else 0
  std::vector<SampledPixel> pixels;
  std::vector<SampleEntry> list = std::vector<SampleEntry>(kBatchCapacity);
  PixelBatch block{kBlockPixels};
};

// Renders a cell of the frame, and writes its pixels that lie in `part` to the strip.
void RenderCell(const FramePlan& plan, const Window& cell, const Window& part, TileWork* work,
                CellRoom* room, Strip* strip);

}  // namespace nacre
