// SPDX-License-Identifier: Apache-2.0
// render/mesh_radiance.h: radiance of hits on meshes whose vertices' radiance is interpolated
// (Gouraud 1971), or whose triangles have one radiance each (flat shading):
// DirectPlan::mesh_radiance.
#pragma once

#include "render/direct_batch.h"
#include "render/shadow_origins.h"

namespace nacre {

// The visible side of a corner, as an index into MeshRadiance::sides. `visible_normal` comes from
// VisibleNormal.
uint32_t SideOf(const TriangleRef& triangle, size_t corner, const Vec3d& visible_normal);

// The unit normal of the triangle on the side that the camera sees; 0 for a degenerate triangle.
Vec3d VisibleNormal(const CameraFrame& camera, const TriangleRef& triangle, const Corners& corners);

// Fills batch.radiance of the interpolated runs.
void InterpolateRadiance(const DirectBatch& batch);

}  // namespace nacre
