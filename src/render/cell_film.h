// SPDX-License-Identifier: Apache-2.0
// render/cell_film.h: the film of adaptive sampling: a cell's pixels, block by block, each with as
// many samples as it took.
#pragma once

#include "render/cell_scratch.h"

namespace nacre {

// Empties the replicates' sums in the blocks in `blocks` (bits).
void ClearReplicates(uint32_t blocks, CellScratch* cell_scratch);

// Adds them to the film's first four channels, the beauty and coverage.
void AddReplicates(uint32_t blocks, const CellScratch& cell_scratch, TileFilm* film);

// The samples of the cell's pixels that lie in `part`.
PixelSampleCounts CountSamples(const Window& cell, const Window& part,
                               const CellScratch& cell_scratch);

// Divides by the numbers of samples, or weighs what hits and the background by the shares of the
// pixels that are known to be covered, and puts the cell's pixels that lie in `part` into the
// strip.
void ResolveCell(const FramePlan& plan, const Window& cell, const Window& part,
                 const TileFilm& film, const CellScratch& cell_scratch, Strip* strip);

}  // namespace nacre
