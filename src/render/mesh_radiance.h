// SPDX-License-Identifier: Apache-2.0
// render/mesh_radiance.h: radiance of hits on meshes whose vertices' radiance is interpolated
// (Gouraud 1971), or whose triangles have one radiance each (flat shading).
#pragma once

#include <array>
#include <vector>

#include "render/direct_batch.h"
#include "render/shadow_origins.h"

namespace nacre {

// The reflected radiance of the vertices of a mesh under Gouraud interpolation, or of the triangles
// of a flat-shaded one.
using SideRadiance = std::vector<std::vector<Vec3f>>;
// Its arrays: the components, then from kFirstLightArray on that of each light that has a layer of
// its own.
inline constexpr size_t kDiffuseArray = 0, kSpecularArray = 1, kFirstLightArray = 2;

struct MeshRadiance {
  MaterialId material;  // a mesh with a split has a MeshRadiance for each of its materials
  // The radiance of the side that the vertices' normals point to, and of the other side.
  // Flat-shaded meshes use only the first, for the side of each triangle that faces the camera.
  std::array<SideRadiance, 2> sides;
};

// By mesh; empty if no mesh has any.
using RadianceOfMeshes = std::vector<std::vector<MeshRadiance>>;

// The visible side of a corner, as an index into MeshRadiance::sides. `visible_normal` comes from
// VisibleNormal.
uint32_t SideOf(const TriangleRef& triangle, size_t corner, const Vec3d& visible_normal);

// The unit normal of the triangle on the side that the camera sees; 0 for a degenerate triangle.
Vec3d VisibleNormal(const CameraFrame& camera, const TriangleRef& triangle, const Corners& corners);

// Fills the radiance of the interpolated runs, after the integrator has filled that of the others.
void InterpolateRadiance(const TracedShapes& shapes, const RadianceOfMeshes& meshes,
                         const Surfaces& surfaces, BatchRadiance* radiance);

}  // namespace nacre
