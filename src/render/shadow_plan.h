// SPDX-License-Identifier: Apache-2.0
// render/shadow_plan.h: decides which shadow rays must be traced, and how their occluders are
// found.
#pragma once

#include "render/direct_plan.h"
#include "render/hits_plan.h"

namespace nacre {

// Decides for each light with shadow rays on which spheres these can be occluded, and whether
// lists, bins or a BVH find the occluders. Makes the intersector compute the lists and bins.
// Returns whether any light needs a BVH, which must then be built.
bool PlanShadows(const Scene& scene, const RenderSettings& settings, const HitsPlan& hits,
                 PreparedScene* prepared, DirectPlan* plan, Explanation* why);

}  // namespace nacre
