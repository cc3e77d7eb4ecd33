// SPDX-License-Identifier: Apache-2.0
// visibility/shell_tree.h: a bounding volume hierarchy for spheres that lie within one another.
//
// A BVH of boxes cannot cull these: the boxes of a thousand nested, coincident or nearly coincident
// spheres all contain the same space, and a ray through it would have to be tested against every
// one. But a ray can only hit the surface of a sphere. The surfaces of a group of spheres lie in a
// shell, the space between two concentric balls, and shells of spheres of about the same centre and
// radius are thin: a ray that has hit one sphere stops before the shells of others, a ray that
// leaves the spheres enters no shell, and one that starts inside all of them crosses a hole first.
// The tree only skips tests that would miss, and makes no assumption about where rays start or end.
#pragma once

#include <cstdint>
#include <vector>

#include "base/huge_pages.h"
#include "base/vec.h"
#include "visibility/sphere_test.h"

namespace nacre {

struct ClosestHits;
struct RayBatch;
struct ShadowRayBatch;
struct TraceGeometry;

// A shell that contains all surface points p of some spheres: inner <= |p - center| <= outer, up to
// rounding.
struct Shell {
  Vec3d center{0, 0, 0};
  double inner = 0;  // 0 or negative: there is no hole
  double outer = 0;
};

// The margin of a shell when a ray is tested against it, relative to the sum of all coordinates
// involved: those of the ray's origin, of the shell's centre and its radius.
//
// The errors of the exact sphere tests (sphere_test.h, projected_sphere_test.h) and of the shell's
// own test are equivalent to a change of the radii and of the distance along the ray by a few 2^-53
// of that sum; this is a few thousand times as much. Surfaces that are nearer together than this
// are not separated by the tree, but tested exactly.
inline constexpr double kShellMargin = 1e-12;

struct ShellNode {
  Shell shell;
  uint32_t first = 0;  // the first of two adjacent child nodes, or of a leaf's members
  uint32_t count = 0;  // number of a leaf's members; 0: the node has children
};

// A group of spheres that coincide, given by the lowest and the highest of their indices. A closest
// hit reports the lowest. Shadow rays check both, because spheres that are the light itself do not
// occlude it; the indices of such spheres are consecutive.
struct ShellMember {
  uint32_t lowest = 0, highest = 0;
};

inline constexpr int kMaxShellDepth = 96;

struct ShellTree {
  std::vector<ShellNode> nodes;  // the root is the first; empty: there is no tree
  std::vector<ShellMember> members;

  bool empty() const { return nodes.empty(); }
};

// Whether so many of the spheres contain a common point that a shell tree pays off; it is slower
// than Embree's BVH or bins where spheres lie side by side. A sample of the spheres decides.
bool AreNested(const HugeArray<TraceSphere>& spheres);

// Takes O(n log n) time on one thread.
ShellTree BuildShellTree(const HugeArray<TraceSphere>& spheres);

// Finds the rays' first hits on spheres in TraceGeometry::shells, packet by packet, and replaces
// those in `hits` that are farther.
void NearerInShells(const TraceGeometry& geometry, const RayBatch& rays, ClosestHits* hits);

// Sets rays->occluded where such a sphere occludes the ray; leaves the others as they are.
void OccludedInShells(const TraceGeometry& geometry, ShadowRayBatch* rays);

}  // namespace nacre
