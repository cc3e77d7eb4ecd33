// SPDX-License-Identifier: Apache-2.0
// render/mesh_radiance.h: hits on meshes that interpolate what their vertices reflect (Gouraud
// 1971), or show what their triangles do (flat shading): DirectPlan::mesh_radiance.
#pragma once

#include "render/direct_batch.h"
#include "render/shadow_origins.h"

namespace nacre {

// Which of a corner's two sides the camera sees, given the normal of the triangle on its side.
uint32_t SideOf(const TriangleRef& triangle, size_t corner, const Vec3d& seen_normal);

// The unit normal of the triangle on the side that the camera sees.
Vec3d SeenNormal(const CameraFrame& camera, const TriangleRef& triangle, const Corners& corners);

// Fills batch.radiance of its interpolated runs.
void InterpolateRadiance(const DirectBatch& batch);

}  // namespace nacre
