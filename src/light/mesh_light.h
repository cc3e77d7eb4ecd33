// SPDX-License-Identifier: Apache-2.0
// light/mesh_light.h: triangles as one light. SIMD twin: mesh_light-inl.h. Directions to it are
// chosen by choosing a triangle, by its area, and then in the triangle (light/triangle_light.h);
// what is seen along a direction is the nearest triangle.
//
// A direction's pdf is the sum over all triangles that lie along it, as each could have led to
// it: so it does not matter which one did, or how many a direction crosses. Half of a closed mesh's
// triangles face away from the point, and no sample of those is lost.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "light/mesh_outline.h"
#include "light/triangle_light.h"
#include "sampling/inverse_cdf.h"

namespace nacre {

// A box around triangles [begin, end) of a tree's order. Inner boxes have two children, `child` and
// the one after it.
struct MeshLightNode {
  Vec3d low, high;
  uint32_t begin = 0, end = 0;
  uint32_t child = 0;  // 0: a leaf
};

struct MeshLight {
  std::vector<TriangleLight<double>> triangles;  // those that have an area
  std::vector<Vec3d> crosses;                    // edge_x cross edge_y of each
  std::vector<double> probabilities;             // area over the sum of all
  std::vector<CdfEntry> by_area;
  std::vector<MeshLightNode> tree;
  // Whether no front hides another front from any point: no corner is before a triangle's plane.
  // And whether none is behind one either.
  bool is_convex = false;
  bool is_flat = false;
  MeshOutline outline;  // of convex solids and polygons; else empty
};

// In the place of 1 / 0 where a ray lies along a slab of a box.
inline constexpr double kSlabInfinity = 1e300;
inline constexpr double kSlabRounding = 1 + 2 * 3 * 0x1p-52;

// The deepest that a tree's stack gets: a tree of halves is no deeper than its count has bits.
inline constexpr size_t kMeshLightStack = 64;

// Meshes of more triangles are never tried for being convex: their irradiance in closed form, a sum
// over all, takes longer than samples.
inline constexpr size_t kMostClosedTriangles = 64;

// Of corners relative to `origin`. Triangles without an area are left out; at least one has some.
MeshLight MakeMeshLight(std::span<const Vec3d> positions, std::span<const uint32_t> triangles,
                        const Vec3d& origin);

// A triangle that a ray from `point` meets, seen from either side, and at which multiple of the
// direction's length.
struct MeshLightMeeting {
  uint32_t triangle;
  double t;  // > 0
};

// Puts all that the ray meets, in any order, into `meetings`.
void FindMeetings(const MeshLight& light, const Vec3d& point, const Vec3d& direction,
                  std::vector<MeshLightMeeting>* meetings);

}  // namespace nacre
