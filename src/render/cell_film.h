// SPDX-License-Identifier: Apache-2.0
// render/cell_film.h: the film of adaptive sampling: the sums of a cell's pixels, which are ordered
// block by block and have different numbers of samples.
#pragma once

#include "render/cell_state.h"

namespace nacre {

// Clears the replicates' sums in the blocks whose bits are set.
void ClearReplicates(uint32_t blocks, CellState* cell_scratch);

// Adds the replicates' sums to the film's first four channels, beauty and coverage.
void AddReplicates(uint32_t blocks, const CellState& cell_scratch, TileFilm* film);

// Counts the samples of the cell's pixels that lie in `part`.
PixelSampleCounts CountSamples(const Window& cell, const Window& part,
                               const CellState& cell_scratch);

// Turns sums into means and writes the cell's pixels that lie in `part` to the strip. A pixel of
// known coverage is the mean of its hits and the background, weighted by the coverage.
void ResolveCell(const FramePlan& plan, const Window& cell, const Window& part,
                 const TileFilm& film, const CellState& cell_scratch, Strip* strip);

}  // namespace nacre
