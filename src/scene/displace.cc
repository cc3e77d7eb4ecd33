// SPDX-License-Identifier: Apache-2.0
#include "scene/displace.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "scene/mesh.h"
#include "scene/texture_mapping.h"

namespace nacre {
namespace {

// The unit direction at (u, v), with v up. Longitudes begin at -z and grow to the right as seen
// from outside.
Vec3d SphereDirection(double u, double v) {
  const double phi = 2 * M_PI * u, theta = M_PI * (1 - v);
  const double ring = std::sin(theta);
  return {-ring * std::sin(phi), std::cos(theta), -ring * std::cos(phi)};
}

// The positions and triangles of `mesh`, with each index replaced by its twin's, so that the
// surface is closed where positions coincide.
Mesh Welded(const Mesh& mesh, const std::vector<uint32_t>& twins) {
  Mesh welded{.positions = mesh.positions, .triangles = mesh.triangles};
  for (uint32_t& index : welded.triangles) index = twins[index];
  return welded;
}

// Replaces each value by the mean over the positions that coincide.
template <class T>
void MeanOfTwins(const std::vector<uint32_t>& twins, std::vector<T>* values) {
  std::vector<T> sums(values->size(), T(0));
  std::vector<double> counts(values->size(), 0);
  for (size_t i = 0; i < values->size(); ++i) {
    sums[twins[i]] += (*values)[i];
    counts[twins[i]] += 1;
  }
  for (size_t i = 0; i < values->size(); ++i) (*values)[i] = sums[twins[i]] / counts[twins[i]];
}

std::vector<Vec3d> NormalsOf(Mesh mesh) {
  ComputeNormals(NormalWeighting::kAngle, 180, &mesh);
  return std::move(mesh.normals);
}

}  // namespace

Mesh TessellateSphere(const Sphere& sphere, int segments) {
  const int rows = std::max(segments / 2, 2);
  Mesh mesh{.material = sphere.material};
  const auto columns = static_cast<size_t>(segments) + 1;
  mesh.positions.reserve(columns * (static_cast<size_t>(rows) + 1));
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= segments; ++column) {
      // The positions on both sides of the seam are equal bit for bit, and so are those at each
      // pole.
      const bool pole = row == 0 || row == rows;
      const double around = pole || column == segments ? 0 : static_cast<double>(column) / segments;
      const double v = static_cast<double>(row) / rows;
      Vec3d normal = SphereDirection(around, v);
      if (pole) normal = Vec3d(0, row == 0 ? -1 : 1, 0);
      mesh.positions.push_back(sphere.center + normal * sphere.radius);
      mesh.normals.push_back(normal);
      mesh.uvs.emplace_back(static_cast<double>(column) / segments, v);
    }
  }
  const auto at = [&](int row, int column) {
    return static_cast<uint32_t>(static_cast<size_t>(row) * columns + static_cast<size_t>(column));
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < segments; ++column) {
      const uint32_t a = at(row, column), b = at(row, column + 1);
      const uint32_t c = at(row + 1, column + 1), d = at(row + 1, column);
      if (row > 0) mesh.triangles.insert(mesh.triangles.end(), {a, b, c});
      if (row + 1 < rows) mesh.triangles.insert(mesh.triangles.end(), {a, c, d});
    }
  }
  return mesh;
}

void Displace(const Scene& scene, const Displacement& displacement, Mesh* mesh) {
  const Texture& texture = scene.textures[displacement.texture.index];
  const MipChain& image = *scene.images[texture.image.index].texels;
  const UvTransform transform = TransformOf(texture);
  const bool smooth = !mesh->normals.empty();
  const std::vector<uint32_t> twins = FindTwins(mesh->positions);
  std::vector<Vec3d> normals = smooth ? mesh->normals : NormalsOf(Welded(*mesh, twins));
  std::vector<double> heights(mesh->positions.size());
  for (size_t i = 0; i < heights.size(); ++i) {
    const Vec3d local = (mesh->positions[i] - displacement.center) / displacement.size;
    const Vec2d uv = texture.mapping == MappingKind::kUv ? transform.Apply(mesh->uvs[i])
                                                         : MapToTexture(texture, local);
    heights[i] = SampleBilinear(image, 0, texture.sampling, uv.x, uv.y, 0);
  }
  MeanOfTwins(twins, &heights);
  MeanOfTwins(twins, &normals);
  for (size_t i = 0; i < heights.size(); ++i) {
    mesh->positions[i] += normals[i].normalized() * (displacement.distance * heights[i]);
  }
  if (!smooth) return;
  mesh->normals = NormalsOf(Welded(*mesh, twins));
  for (size_t i = 0; i < twins.size(); ++i) mesh->normals[i] = mesh->normals[twins[i]];
}

}  // namespace nacre
