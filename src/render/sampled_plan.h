// SPDX-License-Identifier: Apache-2.0
// render/sampled_plan.h: what lights with an extent, and environments, need.
#pragma once

#include "render/plan.h"

namespace nacre {

// The scene with the shapes of its visible lights, or null if none of them can be seen or be in the
// way of other light.
std::shared_ptr<const SceneWithLights> ShowLights(const Scene& scene);

// Fills in the plan's sampled lights, the points that they are sampled by, and the sky.
void PlanSampledLights(const Scene& scene, const RenderSettings& settings, RenderPlan* plan);

// Decides which of their shadow rays need asking, and whom, after PlanShadows. Returns whether any
// are left for a tree.
bool PlanSampledShadows(const Scene& scene, const RenderSettings& settings, RenderPlan* plan);

}  // namespace nacre
