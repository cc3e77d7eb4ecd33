// SPDX-License-Identifier: Apache-2.0
// render/shadow_origins.h: the origins of shadow rays on meshes with smooth normals.
#pragma once

#include <array>

#include "base/vec.h"
#include "render/direct_batch.h"
#include "scene/primitives.h"

namespace nacre {

// A triangle's corners relative to the camera, as hits are.
using Corners = std::array<Vec3d, 3>;
Corners CornersOf(const Scene& scene, const TriangleRef& triangle);

// The barycentric coordinates of a point, clamped to the triangle. (1, 0, 0) for a degenerate
// triangle, which no ray hits.
Vec3d BarycentricsAt(const Corners& corners, const Vec3d& point);

// The origin of a shadow ray from `point` in the triangle, moved onto the smooth surface that the
// unit normals of the corners suggest (Hanika 2021, "Hacking the shadow terminator", Ray Tracing
// Gems II, chapter 4): the weighted mean of the projections of the point onto the tangent planes at
// the corners, where it is below them. Normals are on the side where the ray starts.
Vec3d OffsetOrigin(const Corners& corners, const Corners& normals, const Vec3d& weights,
                   const Vec3d& point);

// Whether some shadow rays start elsewhere than at their hits.
bool PlanShadowOrigins(const Scene& scene, const TracedShapes& shapes, const ShadowPlan& shadows,
                       Explanation* why);

// Fills batch.room.shadow_origin with the origins of the lit hits' shadow rays.
void OffsetShadowOrigins(const DirectBatch& batch);

}  // namespace nacre
