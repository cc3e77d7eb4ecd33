// SPDX-License-Identifier: Apache-2.0
// render/sampled_shadows.h: shadow rays along the directions that are chosen for lights with an
// extent.
#pragma once

#include "render/plan.h"
#include "render/stats.h"

namespace nacre {

struct TileScratch;

// Takes scratch->light from the hits that something lies before the light for, along
// scratch->sampled->directions.
void CastSampledShadows(const RenderPlan& plan, const PlannedSampledLight& planned,
                        TileScratch* scratch, RenderStats* stats);

}  // namespace nacre
