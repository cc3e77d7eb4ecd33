// SPDX-License-Identifier: Apache-2.0
// render/cell_film.h: the film of adaptive sampling: the sums of a cell's pixels, which are ordered
// block by block and have different numbers of samples.
#pragma once

#include "render/cell.h"
#include "render/outline_pixels.h"

namespace nacre {

struct CellSamples {
  uint32_t count[kCellPixels];  // of each pixel in each replicate; 0: only its centre
  // Sums of the samples of each replicate: the three channels of the beauty, and coverage.
  double sums[kReplicates][4][kCellPixels];
};

// Clears the replicates' sums in the blocks whose bits are set.
void ClearReplicates(uint32_t blocks, CellSamples* samples);

// Adds the replicates' sums to the film's first four channels, beauty and coverage.
void AddReplicates(uint32_t blocks, const CellSamples& samples, TileFilm* film);

// Counts the samples of the cell's pixels that lie in `part`.
PixelSampleCounts CountSamples(const Window& cell, const Window& part, const CellSamples& samples);

// Turns sums into means and writes the cell's pixels that lie in `part` to the strip. A pixel of
// known coverage is the mean of its hits and the background, weighted by the coverage.
void ResolveCell(const FramePlan& plan, const Window& cell, const Window& part,
                 const TileFilm& film, const CellSamples& samples, const OutlinePixels& outlines,
                 Strip* strip);

}  // namespace nacre
