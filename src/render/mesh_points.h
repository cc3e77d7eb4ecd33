// SPDX-License-Identifier: Apache-2.0
// render/mesh_points.h: hits on triangles as points between their vertices.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/vec.h"
#include "render/plan.h"

namespace nacre {

struct TileScratch;

// A triangle of the scene.
struct TriangleRef {
  const Mesh* mesh;
  size_t number;      // of the mesh in the scene
  uint32_t triangle;  // of the triangle in the mesh

  uint32_t Vertex(size_t corner) const { return mesh->triangles[3 * size_t{triangle} + corner]; }
};

// `primitive` is one of the triangles' numbers.
TriangleRef TriangleOf(const RenderPlan& plan, uint32_t primitive);

// The triangle's corners relative to the camera, as hits are.
using Corners = std::array<Vec3d, 3>;
Corners CornersOf(const RenderPlan& plan, const TriangleRef& triangle);

// The weights, none negative and of sum 1, of the corners whose mean the point is. Those of the
// first corner alone for a triangle without an area, which nothing hits.
Vec3d WeightsAt(const Corners& corners, const Vec3d& point);

// 1 where the camera sees the triangle's front, -1 where it sees its back: the same for all of it.
double SideSeen(const RenderPlan& plan, const Corners& corners);

// Where a shadow ray from `point` in the triangle starts so that it leaves the surface that the
// unit normals of the corners, on the side where the ray starts, tell of (Hanika 2021, "Hacking the
// shadow terminator", Ray Tracing Gems II, chapter 4): the mean of its projections onto the planes
// at the corners, of those that it is below.
Vec3d LiftedOrigin(const Corners& corners, const Corners& normals, const Vec3d& weights,
                   const Vec3d& point);

// Whether shadow rays of any mesh's hits start elsewhere than at the hits.
bool LiftsShadowOrigins(const Scene& scene);

// Fills scratch->shadow_origin with where the shadow rays of its hits start.
void LiftShadowOrigins(const RenderPlan& plan, TileScratch* scratch);

}  // namespace nacre
