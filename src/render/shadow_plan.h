// SPDX-License-Identifier: Apache-2.0
// render/shadow_plan.h: which shadow rays need tracing, and what finds their occluders.
#pragma once

#include "render/direct_plan.h"
#include "render/hits_plan.h"

namespace nacre {

// Decides for each of the plan's lights that has shadow rays whether any can find something, for
// which spheres, and by what means, and has the intersector find the lights' occluders. Returns
// whether any are left for a tree, which must then be built.
bool PlanShadows(const Scene& scene, const RenderSettings& settings, const HitsPlan& hits,
                 PreparedScene* prepared, DirectPlan* plan, Explanation* why);

}  // namespace nacre
