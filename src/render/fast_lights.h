// SPDX-License-Identifier: Apache-2.0
// render/fast_lights.h: what stands in for samples of lights in their fast mode, and how far off it
// is, which is measured while planning, on the light itself.
//
// What lies in a light's shadow, or may, is sampled as ever: all that a fast mode changes is within
// the error that it tells.
#pragma once

#include <string>

#include "render/plan.h"

namespace nacre {

// Gives `prepared` what its fast mode needs, if that is asked for and it has one. Returns how its
// diffuse reflection comes about where all of the light is seen, in words.
std::string PlanFastLight(const Light& light, const RenderSettings& settings,
                          SampledLight* prepared, RenderPlan* plan);

// After the plan's materials are prepared: gives the lights that have a fast mode the image as the
// materials' lobes see it.
void PlanFastLobes(const Scene& scene, const RenderSettings& settings, RenderPlan* plan);

}  // namespace nacre
