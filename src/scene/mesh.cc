// SPDX-License-Identifier: Apache-2.0
#include "scene/mesh.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace nacre {
namespace {

// The matrix of rotations about x, then y, then z, for Imath's row vectors: v * matrix.
Imath::M33d RotationMatrix(const Vec3d& degrees) {
  const Vec3d angles = degrees * (std::numbers::pi / 180);
  const Vec3d c(std::cos(angles.x), std::cos(angles.y), std::cos(angles.z));
  const Vec3d s(std::sin(angles.x), std::sin(angles.y), std::sin(angles.z));
  const Imath::M33d x(1, 0, 0, 0, c.x, s.x, 0, -s.x, c.x);
  const Imath::M33d y(c.y, 0, -s.y, 0, 1, 0, s.y, 0, c.y);
  const Imath::M33d z(c.z, s.z, 0, -s.z, c.z, 0, 0, 0, 1);
  return x * y * z;
}

}  // namespace

Vec3d FaceNormal(const Mesh& mesh, size_t triangle) {
  const Vec3d& a = mesh.positions[mesh.triangles[3 * triangle]];
  const Vec3d& b = mesh.positions[mesh.triangles[3 * triangle + 1]];
  const Vec3d& c = mesh.positions[mesh.triangles[3 * triangle + 2]];
  return (b - a).cross(c - a).normalized();  // 0 stays 0
}

bool HasArea(const Mesh& mesh) {
  for (size_t i = 0; i < mesh.triangles.size() / 3; ++i) {
    if (FaceNormal(mesh, i) != Vec3d(0, 0, 0)) return true;
  }
  return false;
}

void DropMeshesWithoutArea(Scene* scene) {
  std::erase_if(scene->meshes, [](const Mesh& mesh) { return !HasArea(mesh); });
}

void ApplyTransform(const Transform& transform, Mesh* mesh) {
  const Imath::M33d rotation = RotationMatrix(transform.rotate_deg);
  for (Vec3d& position : mesh->positions) {
    position = (position * transform.scale) * rotation + transform.translate;
  }
  for (Vec3d& normal : mesh->normals) {
    // The inverse transpose of a scaling is the scaling by the reciprocals; that of a rotation is
    // the rotation itself.
    normal = ((normal / transform.scale) * rotation).normalized();
  }
  const Vec3d& scale = transform.scale;
  const bool mirrored = ((scale.x < 0) != (scale.y < 0)) != (scale.z < 0);
  for (auto& [direction, sign] : mesh->tangents) {
    direction = ((direction * scale) * rotation).normalized();
    if (mirrored) sign = -sign;  // the bitangent is a cross product
  }
  if (!mirrored) return;
  for (size_t i = 0; i < mesh->triangles.size(); i += 3) {
    std::swap(mesh->triangles[i + 1], mesh->triangles[i + 2]);
  }
}

}  // namespace nacre
