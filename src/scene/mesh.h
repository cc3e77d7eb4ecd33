// SPDX-License-Identifier: Apache-2.0
// scene/mesh.h: functions on triangle meshes: face normals, vertex normals (vertex_normals.cc),
// transforms.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace nacre {

// The texture coordinates of the mesh: the second set if `second` is true and the mesh has one,
// else the first.
inline const std::vector<Vec2d>& UvsOf(const Mesh& mesh, bool second) {
  return second && !mesh.second_uvs.empty() ? mesh.second_uvs : mesh.uvs;
}

// The unit normal of a triangle by the right-hand rule, or 0 if its area is exactly 0. Scale-free:
// no triangle is too small (an absolute threshold would lose small meshes).
Vec3d FaceNormal(const Mesh& mesh, size_t triangle);

// The unit vector of a sum of face normals; (0, 1, 0) if they cancel out.
Vec3d UnitOrUp(const Vec3d& sum);

// How much each face around a vertex counts for its normal.
enum class NormalWeighting : uint8_t {
  kAngle,    // by its angle there: does not depend on how the surface is cut into triangles
             // (Thuermer and Wuethrich 1998)
  kArea,     // by its area
  kUniform,  // equally, as lessons do
};

// Gives the mesh unit normals, one per position, each the weighted average of the faces around it;
// (0, 1, 0) where no face has an area or they cancel out. Positions at the same place that differ
// only in uvs count as one. Tangents are removed, because they belong to the old normals.
//
// Faces that meet along an edge at more than crease_angle_deg are not averaged over it: positions
// are repeated, so that each side has normals of its own. From 180 on, nothing is a crease. Where
// more than two faces share an edge, only consecutive triangles are compared. Runs on up to
// `threads` threads (0: as many as the machine has).
void ComputeNormals(NormalWeighting weighting, double crease_angle_deg, Mesh* mesh,
                    int threads = 1);

// The crease angle of models that have no normals and do not say which of their edges are sharp.
inline constexpr double kModelCreaseAngleDeg = 45;

// Replaces normals that are not unit vectors by angle-weighted averages of the faces.
void MendNormals(Mesh* mesh);

// For each position, the lowest index of the positions that equal it.
std::vector<uint32_t> FindTwins(const std::vector<Vec3d>& positions);

// Whether any triangle has an area.
bool HasArea(const Mesh& mesh);

// Removes the meshes that no ray can hit.
void DropMeshesWithoutArea(Scene* scene);

// Scales, then rotates about x, then y, then z by right-handed degrees, then translates.
struct Transform {
  Vec3d translate{0, 0, 0};
  Vec3d scale{1, 1, 1};  // no component 0; an odd number of negative ones mirrors
  Vec3d rotate_deg{0, 0, 0};
};

// Transforms positions, normals and tangents. The winding of a mirrored mesh is reversed, so that
// its outside stays outside.
void ApplyTransform(const Transform& transform, Mesh* mesh);

}  // namespace nacre
