// SPDX-License-Identifier: Apache-2.0
// render/rare_features.h: what is known, before a pixel's first sample, of things in it that few of
// its samples find: spheres that are smaller than a pixel.
#pragma once

#include "render/adaptive.h"

namespace nacre {

// The largest mean radiance that the picture of a whole small object can have: WhiteLevel, or
// without one what area lights and skies make of it; infinite where that is not known.
double BrightestObject(const RenderPlan& plan);

// Sets rare_samples and rare_radiance of the cell's pixels from its spheres.
void FindRareSpheres(const RenderPlan& plan, const Window& cell, const TileCandidates& candidates,
                     CellScratch* cell_scratch);

}  // namespace nacre
