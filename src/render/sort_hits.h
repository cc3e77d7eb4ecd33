// SPDX-License-Identifier: Apache-2.0
// render/sort_hits.h: the hits of a batch in runs of one material.
#pragma once

#include "render/plan.h"

namespace nacre {

struct TileScratch;

// Sorts the scratch's hits by material and finds its runs: within a run hits are in the order of
// their rays, so that what a hit's lane computes never depends on its neighbours.
void SortHits(const RenderPlan& plan, TileScratch* scratch);

}  // namespace nacre
