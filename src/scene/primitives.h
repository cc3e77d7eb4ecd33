// SPDX-License-Identifier: Apache-2.0
// scene/primitives.h: numbers the scene's primitives consecutively: spheres first, in scene order,
// then the triangles of all meshes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "scene/shapes.h"

namespace nacre {

struct Scene;

struct PrimitiveNumbers {
  const Scene* scene = nullptr;
  // For each mesh, the number of triangles before its own.
  std::vector<uint32_t> mesh_first_triangle;
};

size_t CountTriangles(const Scene& scene);

// `scene` must outlive the numbers.
PrimitiveNumbers NumberPrimitives(const Scene& scene);

struct TriangleRef {
  const Mesh* mesh;
  size_t number;      // of the mesh in the scene
  uint32_t triangle;  // of the triangle in the mesh

  uint32_t Vertex(size_t corner) const { return mesh->triangles[3 * size_t{triangle} + corner]; }
};

bool IsSphere(const PrimitiveNumbers& numbers, uint32_t primitive);

// `primitive` must be a triangle.
TriangleRef TriangleOf(const PrimitiveNumbers& numbers, uint32_t primitive);

// The number of the object that a primitive belongs to: the index of the sphere, or the number of
// spheres plus the index of the mesh.
uint32_t ObjectOf(const PrimitiveNumbers& numbers, uint32_t primitive);

// The unit normal of the triangle `primitive`, by the right-hand rule.
Vec3d FaceNormalOf(const PrimitiveNumbers& numbers, uint32_t primitive);

// The material of the primitive's sphere or mesh, which may be a split.
MaterialId ShapeMaterial(const PrimitiveNumbers& numbers, uint32_t primitive);

}  // namespace nacre
