// SPDX-License-Identifier: Apache-2.0
// render/mesh_shading.h: shades the vertices or triangles of meshes that interpolate radiance
// (mesh_radiance.h), once, while the plan is made.
#pragma once

#include "render/mesh_radiance.h"
#include "render/stats.h"
#include "render/surfaces.h"

namespace nacre {

struct ShadedMeshes {
  RadianceOfMeshes radiance;
  RenderStats stats;  // of this shading: lights and rays, which belong to the frame's
};

ShadedMeshes ShadeMeshes(const Scene& scene, const RenderSettings& settings,
                         const SurfacePlan& surfaces, const DirectPlan& direct, Explanation* why);

}  // namespace nacre
