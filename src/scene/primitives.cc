// SPDX-License-Identifier: Apache-2.0
#include "scene/primitives.h"

#include <algorithm>

#include "scene/mesh.h"

namespace nacre {

size_t CountTriangles(const Scene& scene) {
  size_t triangles = 0;
  for (const Mesh& mesh : scene.meshes) triangles += mesh.triangles.size() / 3;
  return triangles;
}

PrimitiveNumbers NumberPrimitives(const Scene& scene) {
  PrimitiveNumbers numbers{&scene, {}};
  size_t triangles = 0;
  for (const Mesh& mesh : scene.meshes) {
    numbers.mesh_first_triangle.push_back(static_cast<uint32_t>(triangles));
    triangles += mesh.triangles.size() / 3;
  }
  return numbers;
}

bool IsSphere(const PrimitiveNumbers& numbers, uint32_t primitive) {
  return primitive < numbers.scene->spheres.size();
}

TriangleRef TriangleOf(const PrimitiveNumbers& numbers, uint32_t primitive) {
  const Scene& scene = *numbers.scene;
  const uint32_t triangle = primitive - static_cast<uint32_t>(scene.spheres.size());
  const auto& first = numbers.mesh_first_triangle;
  const auto after = std::upper_bound(first.begin(), first.end(), triangle);
  const auto number = static_cast<size_t>(after - first.begin()) - 1;
  return {&scene.meshes[number], number, triangle - first[number]};
}

uint32_t ObjectOf(const PrimitiveNumbers& numbers, uint32_t primitive) {
  if (IsSphere(numbers, primitive)) return primitive;
  const auto spheres = static_cast<uint32_t>(numbers.scene->spheres.size());
  return spheres + static_cast<uint32_t>(TriangleOf(numbers, primitive).number);
}

Vec3d FaceNormalOf(const PrimitiveNumbers& numbers, uint32_t primitive) {
  const TriangleRef triangle = TriangleOf(numbers, primitive);
  return FaceNormal(*triangle.mesh, triangle.triangle);
}

MaterialId ShapeMaterial(const PrimitiveNumbers& numbers, uint32_t primitive) {
  return IsSphere(numbers, primitive) ? numbers.scene->spheres[primitive].material
                                      : TriangleOf(numbers, primitive).mesh->material;
}

}  // namespace nacre
