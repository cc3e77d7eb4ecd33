// SPDX-License-Identifier: Apache-2.0
// render/mesh_shading.h: what the vertices or triangles of meshes reflect, where that is what hits
// on them show (mesh_radiance.h): worked out once, in the plan.
#pragma once

#include "render/direct_plan.h"
#include "render/surfaces.h"

namespace nacre {

// Fills plan->mesh_radiance; all else of the plan is there.
void ShadeMeshes(const Scene& scene, const RenderSettings& settings, const SurfacePlan& surfaces,
                 DirectPlan* plan, Explanation* why);

}  // namespace nacre
