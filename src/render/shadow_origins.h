// SPDX-License-Identifier: Apache-2.0
// render/shadow_origins.h: where shadow rays start on meshes with smooth normals.
#pragma once

#include <array>

#include "base/vec.h"
#include "render/direct_batch.h"
#include "scene/primitives.h"

namespace nacre {

// A triangle's corners relative to the camera, as hits are.
using Corners = std::array<Vec3d, 3>;
Corners CornersOf(const Scene& scene, const TriangleRef& triangle);

// The weights, none negative and of sum 1, of the corners whose mean the point is. Those of the
// first corner alone for a triangle without an area, which nothing hits.
Vec3d WeightsAt(const Corners& corners, const Vec3d& point);

// Where a shadow ray from `point` in the triangle starts so that it leaves the surface that the
// unit normals of the corners, on the side where the ray starts, tell of (Hanika 2021, "Hacking the
// shadow terminator", Ray Tracing Gems II, chapter 4): the mean of its projections onto the planes
// at the corners, of those that it is below.
Vec3d OffsetOrigin(const Corners& corners, const Corners& normals, const Vec3d& weights,
                   const Vec3d& point);

// Whether shadow rays of any mesh's hits start elsewhere than at the hits.
bool OffsetsShadowOrigins(const Scene& scene);

// Fills batch.room.shadow_origin with where the shadow rays of the lit hits start.
void OffsetShadowOrigins(const DirectBatch& batch);

}  // namespace nacre
