// SPDX-License-Identifier: Apache-2.0
// render/rare_features.h: what is known, before a pixel's first sample, of things in it that few of
// its samples find: spheres that are smaller than a pixel, and highlights that are (glints.h).
#pragma once

#include "render/adaptive.h"

namespace nacre {

// The largest mean radiance that the picture of a whole small object can have: WhiteLevel, or
// without one what area lights and skies make of it; infinite where that is not known.
double BrightestObject(const RenderPlan& plan);

// Sets rare_samples and rare_radiance of the cell's pixels from its spheres, which are
// scratch->candidates. Highlights are looked at by a sample each.
void FindRareFeatures(const RenderPlan& plan, const Window& cell, TileScratch* scratch,
                      CellScratch* cell_scratch, StageClock* clock, RenderStats* stats);

}  // namespace nacre
