// SPDX-License-Identifier: Apache-2.0
// light/mesh_outline.h: meshes that are seen from anywhere as one convex outline: closed convex
// solids and convex polygons. Their irradiance is a sum over the outline's edges alone, which are
// those between a triangle that faces the point and one that does not (SIMD:
// mesh_outline-inl.h). The truth: the sum of the irradiances of the triangles that face it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace nacre {

inline constexpr uint32_t kNoFace = 0xffffffffu;

// An edge of two triangles: `left` has it from `from` to `to`, and `right` the other way round.
struct OutlineEdge {
  uint32_t from, to;
  uint32_t left, right;  // right: kNoFace at a polygon's border
};

struct OutlineFace {
  uint32_t corner;  // one of its three
  Vec3d cross;      // to the side that it faces
};

struct MeshOutline {
  std::vector<Vec3d> corners;  // each once
  std::vector<OutlineFace> faces;
  std::vector<OutlineEdge> edges;
};

// As many corners as kMostClosedTriangles triangles that are joined at their edges can have.
inline constexpr size_t kMostOutlineCorners = 66;

// Of a mesh whose triangles have no corner before their planes, and, if it is flat, all corners in
// one plane. Corners are made relative to `origin`. Empty if its outline may be another: open at
// some edge, or not convex.
MeshOutline MakeMeshOutline(std::span<const Vec3d> positions, std::span<const uint32_t> triangles,
                            const Vec3d& origin, bool is_flat);

}  // namespace nacre
