// SPDX-License-Identifier: Apache-2.0
// render/hit_positions.h: decides when hits need their positions and double directions.
#pragma once

#include "render/direct_batch.h"
#include "render/film.h"
#include "render/hits_plan.h"
#include "render/surfaces.h"

namespace nacre {

// `direct` and `layers` are what reads the hits of the surfaces.
HitArrays PlanHitArrays(const RenderSettings& settings, const TracePlan& trace,
                        const SurfacePlan& surfaces, const DirectPlan& direct,
                        const std::vector<Layer>& layers, Explanation* why);

}  // namespace nacre
