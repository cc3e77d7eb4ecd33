// SPDX-License-Identifier: Apache-2.0
// visibility/shell_tree.h: a bounding volume hierarchy for spheres that lie within one another.
//
// A tree of boxes cannot cull these: the boxes of a thousand nested, coincident or nearly
// coincident spheres all hold the same space, and a ray through it has to be tested against every
// one. But all that a ray can hit of a sphere is its surface. The surfaces of a group of spheres
// lie in a shell, the space between two concentric balls, and shells of spheres of about the same
// centre and radius are thin: a ray that has hit one sphere stops before the others' shells, a ray
// that leaves them does not meet any, and one that starts inside them all crosses a hole first.
// Nothing is assumed of where rays start and go to: the tree only leaves out tests that would miss.
#pragma once

#include <cstdint>
#include <vector>

#include "base/huge_pages.h"
#include "base/vec.h"

namespace nacre {

struct TraceSphere;

// Holds all surface points p of some spheres: inner <= |p - center| <= outer, but for rounding.
struct Shell {
  Vec3d center{0, 0, 0};
  double inner = 0;  // not above 0: there is no hole
  double outer = 0;
};

// How much thicker a shell has to be taken when a ray is tested against it, as a share of the sum
// of all coordinates involved: those of the ray's origin, the shell's centre and its radius.
//
// The exact tests of a sphere (sphere_test.h, film_test.h) and the shell's own test err like a
// change of the radii and of the way along the ray by a few 2^-53 of that sum; this is a few
// thousand times as much. What is nearer together than this is not told apart by the tree, but
// tested exactly.
inline constexpr double kShellMargin = 1e-12;

struct ShellNode {
  Shell shell;
  uint32_t first = 0;  // the first of two child nodes, which are neighbours; or of a leaf's members
  uint32_t count = 0;  // of a leaf's members; 0: the node has children
};

// Spheres that coincide, by the lowest and the highest of their numbers. Closest hits are those of
// the lowest; shadow rays ask both, for those that have a light's own number do not block it, and
// such numbers follow one another.
struct ShellMember {
  uint32_t lowest = 0, highest = 0;
};

inline constexpr int kMaxShellDepth = 96;  // of nodes above one another

struct ShellTree {
  std::vector<ShellNode> nodes;  // the root is the first; empty: there is no tree
  std::vector<ShellMember> members;

  bool empty() const { return nodes.empty(); }
};

// Whether so many of the spheres hold one place together that a shell tree is worth it: it takes
// longer than Embree's tree or bins where spheres lie side by side. Looks at a sample.
bool AreNested(const HugeArray<TraceSphere>& spheres);

// Takes O(n log n) on one thread.
ShellTree BuildShellTree(const HugeArray<TraceSphere>& spheres);

}  // namespace nacre
