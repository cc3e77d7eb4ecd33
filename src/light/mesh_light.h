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

inline constexpr size_t kMeshLightWidth = 16;  // maximum children of a node: a vector of floats
inline constexpr size_t kMeshLightLeaf = 8;    // maximum triangles of a leaf: a vector of doubles

// A node of a bounding volume hierarchy. The children's boxes are rounded outwards to floats.
struct MeshLightNode {
  alignas(64) float low[3][kMeshLightWidth];
  alignas(64) float high[3][kMeshLightWidth];
  uint32_t count = 0;               // the number of children
  uint32_t child[kMeshLightWidth];  // a node's index; or a leaf's, if the bit is set in `leaves`
  uint32_t leaves = 0;
};

struct MeshLightLeaf {
  alignas(64) double corner[3][kMeshLightLeaf];
  alignas(64) double edge_x[3][kMeshLightLeaf];
  alignas(64) double edge_y[3][kMeshLightLeaf];
  alignas(64) double cross[3][kMeshLightLeaf];  // edge_x cross edge_y; 0 in unused entries
  uint32_t triangle[kMeshLightLeaf];            // index in MeshLight::triangles
};

struct MeshLight {
  std::vector<TriangleLight<double>> triangles;  // those that have an area
  std::vector<Vec3d> crosses;                    // edge_x cross edge_y of each
  std::vector<double> probabilities;             // area over the sum of all
  std::vector<CdfEntry> by_area;
  std::vector<MeshLightNode> nodes;  // the first is the root
  std::vector<MeshLightLeaf> leaves;
  double radius = 0;  // of the ball around the origin that holds all triangles
  // Convex: no corner lies in front of any triangle's plane, so that from no point a front face
  // hides another one. Flat: no corner lies behind one either.
  bool is_convex = false;
  bool is_flat = false;
  MeshOutline outline;  // of convex solids and polygons; else empty
};

// The size of the traversal stack. A node pushes at most kMeshLightWidth entries. Halving 2^32
// triangles down to leaves of 8 takes 29 levels, 4 of which make one level of nodes.
inline constexpr size_t kMeshLightStack = 8 * kMeshLightWidth;

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

// Sets `hits` to all hits of the ray, in any order. Tests every triangle.
void FindMeshLightHits(const MeshLight& light, const Vec3d& point, const Vec3d& direction,
                       std::vector<MeshLightHit>* hits);

}  // namespace nacre
