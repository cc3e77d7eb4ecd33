// SPDX-License-Identifier: Apache-2.0
// render/convergence.h: decides when a pixel of adaptive sampling has enough samples.
#pragma once

#include "render/evidence.h"

namespace nacre {

// Convergence is tested for the first time after this many levels, or one level earlier. All
// samples of the levels before the last of these are added by whole blocks.
inline constexpr size_t kCommonLevels = 3;

// After a level: removes the pixels that have converged from the active ones. After a block's
// common levels the block is removed if all of its pixels are within their tolerances; later,
// single pixels whose neighbours are not far from their tolerances either.
void DropConverged(const FramePlan& plan, size_t level, CellState* state);

// Counts the pixels in `part` that are still active after the last level and whose relative error
// may be more than max_error. Here a highlight's error is relative to the highlight, not to white.
size_t CountUnsettled(const FramePlan& plan, const Window& cell, const Window& part,
                      CellState* state);

}  // namespace nacre
