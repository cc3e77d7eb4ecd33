// SPDX-License-Identifier: Apache-2.0
// render/shadow_cull.h: which shadow rays of a scene of spheres need asking, and whom.
#pragma once

#include "render/plan.h"

namespace nacre {

// Why Intersector::SpheresAreNested leaves a tree to find what rays meet.
inline constexpr char kNestedSpheres[] =
    "many spheres lie within one another: a tree of shells tells them apart sooner";

// True if every camera ray surely starts outside every sphere: what is seen of one is then its
// outside, and light that it faces cannot be behind itself.
bool EyeIsOutside(const Scene& scene, int threads);

// Decides for each of the plan's lights that has shadow rays whether any can find something, for
// which spheres, and by what means; the plan has its intersector. Returns whether any are left for
// a tree, which must then be built.
bool PlanShadows(const Scene& scene, const RenderSettings& settings, RenderPlan* plan);

}  // namespace nacre
