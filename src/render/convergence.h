// SPDX-License-Identifier: Apache-2.0
// render/convergence.h: when a pixel of adaptive sampling has samples enough.
#pragma once

#include "render/cell_scratch.h"

namespace nacre {

// Levels after which blocks are asked first whether they have converged, at the latest: all samples
// of level 0 and 1 are then added by whole blocks.
inline constexpr size_t kCommonLevels = 3;

// Finds, before their first sample, the active pixels that outlines cross, and what is covered of
// those that the outline of one sphere crosses before the background.
void FindOutlines(const FramePlan& plan, const Window& cell, CellScratch* cell_scratch);

// Takes the pixels that have converged from the active ones, after a level: whole blocks after
// their common levels, and then the pixels whose neighbours, too, are not far from what they want.
void DropConverged(const FramePlan& plan, size_t level, CellScratch* cell_scratch);

// Of the pixels that are still active after the last level, those whose error may be more than the
// wanted part of their value: highlights that are not as exact as white is do not count.
// Those of the cell that lie in `part` are counted.
size_t CountUnsettled(const FramePlan& plan, const Window& cell, const Window& part,
                      CellScratch* cell_scratch);

}  // namespace nacre
