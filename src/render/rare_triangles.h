// SPDX-License-Identifier: Apache-2.0
// render/rare_triangles.h: which of a cell's small triangles (small_triangles.h) are rare in its
// pixels, and what they look like.
//
// Of a finely cut mesh all triangles are small and none is rare: where those of one material that
// show one side cover half of a pixel, or of the 3x3 pixels around it as much as the widest of what
// is rare does, they are found like anything large, and its edges like those of anything large. The
// others are looked at by a sample in the middle of each: those that are hidden do not count, and
// those that look like what is beside them do not matter (evidence.h).
#pragma once

#include "render/cell_scratch.h"

namespace nacre {

// Sets cell_scratch->rare_triangles.
void FindRareTriangles(const FramePlan& plan, const Window& cell, TileWork* work,
                       CellScratch* cell_scratch, StageClock* clock, RenderStats* stats);

}  // namespace nacre
