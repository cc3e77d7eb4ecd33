// SPDX-License-Identifier: Apache-2.0
// light/mesh_light.h: a triangle mesh as one light. SIMD twin: mesh_light-inl.h. A sample chooses a
// triangle by area, and then a direction to it (light/triangle_light.h); the radiance is that of
// the nearest triangle along the direction.
//
// The pdf of a direction is the sum over all triangles that it crosses, because each of them
// could have been chosen. Samples are therefore valid whichever triangle was chosen, also if it
// faces away from the point, as half of a closed mesh's triangles do.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "light/mesh_outline.h"
#include "light/triangle_light.h"
#include "sampling/inverse_cdf.h"

namespace nacre {

// A node of a bounding volume hierarchy: the box of triangles [begin, end). Inner nodes have two
// children, `child` and the one after it.
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
  // Convex: no corner lies in front of any triangle's plane, so that from no point a front face
  // hides another one. Flat: no corner lies behind one either.
  bool is_convex = false;
  bool is_flat = false;
  MeshOutline outline;  // of convex solids and polygons; else empty
};

// Replaces 1 / 0 where a ray is parallel to a slab of a box, because 0 times infinity is NaN.
inline constexpr double kSlabInfinity = 1e300;
inline constexpr double kSlabRounding = 1 + 2 * 3 * 0x1p-52;

// The size of the traversal stack: a tree that is split into halves is no deeper than the number of
// bits of its count.
inline constexpr size_t kMeshLightStack = 64;

// Meshes with more triangles are not checked for convexity: summing their irradiance in closed form
// over all triangles takes longer than sampling.
inline constexpr size_t kMaxClosedFormTriangles = 64;

// The corners become relative to `origin`. Triangles without area are left out; at least one must
// have area.
MeshLight MakeMeshLight(std::span<const Vec3d> positions, std::span<const uint32_t> triangles,
                        const Vec3d& origin);

// A hit of a ray on a triangle, from either side.
struct MeshLightHit {
  uint32_t triangle;
  double t;  // > 0, in units of the direction
};

// Sets `hits` to all hits of the ray, in any order.
void FindMeshLightHits(const MeshLight& light, const Vec3d& point, const Vec3d& direction,
                       std::vector<MeshLightHit>* hits);

}  // namespace nacre
