// SPDX-License-Identifier: Apache-2.0
// light/mesh_outline.h: meshes that have one convex outline from every point: closed convex solids
// and convex polygons. Their irradiance is a sum over the outline's edges, which are the edges
// between a triangle that faces the point and one that does not (SIMD: mesh_outline-inl.h). It
// equals the sum of the irradiances of all triangles that face the point.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace nacre {

inline constexpr uint32_t kNoFace = 0xffffffffu;

// An edge shared by two triangles. It runs from `from` to `to` in the face `left`, and the other
// way in the face `right`.
struct OutlineEdge {
  uint32_t from, to;
  uint32_t left, right;  // right: kNoFace at a polygon's border
};

struct OutlineFace {
  uint32_t corner;  // any of the three
  Vec3d cross;      // the cross product of two edges, on the side that the face emits to
};

struct MeshOutline {
  std::vector<Vec3d> corners;  // without duplicates
  std::vector<OutlineFace> faces;
  std::vector<OutlineEdge> edges;
};

// The maximum number of corners of kMaxClosedFormTriangles triangles that are connected by edges.
inline constexpr size_t kMaxOutlineCorners = 66;

// The mesh must be convex in the sense of MeshLight::is_convex and, if `is_flat`, flat. Corners
// become relative to `origin`. The result is empty if the mesh is not a closed solid or a convex
// polygon, so that its outline may be a different one.
MeshOutline MakeMeshOutline(std::span<const Vec3d> positions, std::span<const uint32_t> triangles,
                            const Vec3d& origin, bool is_flat);

}  // namespace nacre
