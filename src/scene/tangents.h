// SPDX-License-Identifier: Apache-2.0
// scene/tangents.h: the tangents in which a mesh's normal maps are given: MikkTSpace's (Mikkelsen
// 2008, "Simulation of Wrinkled Surfaces Revisited", and mikktspace.com), which bakers of normal
// maps and glTF agree on, or those that a file brings along.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/shapes.h"

namespace nacre {

// One tangent for each corner of each triangle. A direction of 0 says that there is none, because
// no triangle around the corner has an area in the texture: the normal then stays as it is.
struct CornerTangents {
  std::vector<uint32_t> corners;  // for each entry of Mesh::triangles, one of `tangents`
  std::vector<Tangent> tangents;  // unit or 0
};

// How a texture transforms coordinates before it is looked up: (u', v') is (u_row.uv, v_row.uv)
// plus an offset, which does not matter here.
struct UvRows {
  Vec2d u_row{1, 0}, v_row{0, 1};
  bool operator==(const UvRows&) const = default;
};

// The rows of a rotation, with or without a reflection, that makes the same tangents: these depend
// on the direction in which u' grows, perpendicular to v_row, and on the side to which v' grows,
// but not on how fast. 0 if `rows` are singular.
UvRows RowsOfSameTangents(const UvRows& rows);

// MikkTSpace's tangents of the mesh, in world space, for the coordinates `uvs` (one per position)
// transformed by `rows`:
//   - Corners whose position, normal and coordinates are equal are one vertex. The normals are
//     those that are interpolated, or the faces'.
//   - Around a vertex, triangles that are connected over edges and are not mirrored with respect to
//     one another in the texture form a group, which shares a tangent. A triangle without an area
//     in the texture joins the first group that reaches it and adds nothing to it.
//   - The tangent is the average, by the angles at the vertex, of the triangles' directions of
//     growing u', each projected on the plane across the normal and normalised.
// Differences from mikktspace.c: sums are in double; exactly opposite directions are averaged, too
// (its angular threshold of 180 degrees separates them); a corner without any tangent gets 0
// instead of (1, 0, 0).
// The time is proportional to the number of triangles. `threads` is that of ParallelFor; the result
// does not depend on it.
CornerTangents MakeTangents(const Mesh& mesh, const std::vector<Vec2d>& uvs, const UvRows& rows,
                            int threads);

// Mesh::tangents, which belong to the untransformed coordinates, rotated and mirrored for the
// coordinates that `rows` makes, as if u and v grew equally fast on the surface.
CornerTangents RotateTangents(const Mesh& mesh, const UvRows& rows);

}  // namespace nacre
