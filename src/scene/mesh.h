// scene/mesh.h: work on triangle meshes: face normals, smooth normals, transforms.
#pragma once

#include <cstddef>
#include <vector>

#include "scene/scene.h"

namespace nacre {

// The unit normal of a triangle by the right-hand rule, or 0 if its area is exactly 0. Scale-free:
// no triangle is too small (an absolute threshold would lose small meshes).
Vec3d FaceNormal(const Mesh& mesh, size_t triangle);

// One unit normal per position: the average of the faces around it, weighted by their angles there
// (Thuermer and Wuethrich 1998), which does not depend on how the surface is cut into triangles.
// (0, 1, 0) where no face has an area or they cancel out.
std::vector<Vec3d> AngleWeightedNormals(const Mesh& mesh);

// Scales, then rotates about x, then y, then z by right-handed degrees, then translates.
struct Transform {
  Vec3d translate{0, 0, 0};
  Vec3d scale{1, 1, 1};  // no component 0; an odd number of negative ones mirrors
  Vec3d rotate_deg{0, 0, 0};
};

// Transforms positions and normals; a mirrored mesh keeps its outside outside.
void ApplyTransform(const Transform& transform, Mesh* mesh);

}  // namespace nacre
