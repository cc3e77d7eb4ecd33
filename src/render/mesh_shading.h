// SPDX-License-Identifier: Apache-2.0
// render/mesh_shading.h: shades the vertices or triangles of meshes that interpolate radiance
// (mesh_radiance.h), once, while the plan is made.
#pragma once

#include "render/direct_plan.h"
#include "render/stats.h"
#include "render/surfaces.h"

namespace nacre {

// Fills plan->mesh_radiance. All other members of the plan must be set. Returns the counts of
// lights and rays of this shading, which belong to the frame's.
RenderStats ShadeMeshes(const Scene& scene, const RenderSettings& settings,
                        const SurfacePlan& surfaces, DirectPlan* plan, Explanation* why);

}  // namespace nacre
