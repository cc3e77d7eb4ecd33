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

#include "render/cell_scratch.h"

namespace nacre {

// Renders the pixels of `part` of a cell of the frame into the strip.
void RenderCell(const FramePlan& plan, const Window& cell, const Window& part, TileWork* work,
                CellScratch* cell_scratch, Strip* strip, StageClock* clock, RenderStats* stats);

}  // namespace nacre
