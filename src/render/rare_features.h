// SPDX-License-Identifier: Apache-2.0
// render/rare_features.h: what is known, before a pixel's first sample, of things in it that few of
// its samples find: spheres and triangles (rare_triangles.h) that are smaller than a pixel, and
// highlights that are
// (glints.h, mesh_glints.h).
#pragma once

#include "render/cell_scratch.h"

namespace nacre {

// Sets rare_samples and rare_radiance of the cell's pixels from its spheres, which are
// work->sight.spheres, and rare_triangles. Highlights are looked at by a sample each.
void FindRareFeatures(const FramePlan& plan, const Window& cell, TileWork* work,
                      CellScratch* cell_scratch, StageClock* clock, RenderStats* stats);

}  // namespace nacre
