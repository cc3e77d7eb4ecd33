// SPDX-License-Identifier: Apache-2.0
#include "scene/sphere_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

namespace nacre {
namespace {

// Cuts every triangle of a unit sphere in four; `directions` are its vertices.
std::vector<uint32_t> Subdivide(const std::vector<uint32_t>& triangles,
                                std::vector<Vec3d>* directions) {
  std::unordered_map<uint64_t, uint32_t> middles;
  middles.reserve(triangles.size() / 2);
  const auto middle = [&](uint32_t a, uint32_t b) {
    const uint64_t edge = uint64_t{std::min(a, b)} << 32 | std::max(a, b);
    const auto next = static_cast<uint32_t>(directions->size());
    const auto [entry, is_new] = middles.try_emplace(edge, next);
    if (is_new) directions->push_back(((*directions)[a] + (*directions)[b]).normalized());
    return entry->second;
  };
  std::vector<uint32_t> cut;
  cut.reserve(4 * triangles.size());
  for (size_t i = 0; i < triangles.size(); i += 3) {
    const uint32_t a = triangles[i], b = triangles[i + 1], c = triangles[i + 2];
    const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    cut.insert(cut.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
  }
  return cut;
}

void PlaceVertices(const Vec3d& center, double radius, std::vector<Vec3d> directions, Mesh* mesh) {
  mesh->positions.reserve(directions.size());
  for (const Vec3d& direction : directions) mesh->positions.push_back(center + direction * radius);
  mesh->normals = std::move(directions);
}

}  // namespace

Mesh MakeMesh(const Icosphere& sphere) {
  // The corners of three golden rectangles.
  constexpr double kGolden = std::numbers::phi;
  std::vector<Vec3d> directions = {{-1, kGolden, 0},  {1, kGolden, 0},   {-1, -kGolden, 0},
                                   {1, -kGolden, 0},  {0, -1, kGolden},  {0, 1, kGolden},
                                   {0, -1, -kGolden}, {0, 1, -kGolden},  {kGolden, 0, -1},
                                   {kGolden, 0, 1},   {-kGolden, 0, -1}, {-kGolden, 0, 1}};
  for (Vec3d& direction : directions) direction.normalize();
  std::vector<uint32_t> triangles = {0, 11, 5, 0, 5,  1,  0,  1,  7,  0,  7, 10, 0, 10, 11,
                                     1, 5,  9, 5, 11, 4,  11, 10, 2,  10, 7, 6,  7, 1,  8,
                                     3, 9,  4, 3, 4,  2,  3,  2,  6,  3,  6, 8,  3, 8,  9,
                                     4, 9,  5, 2, 4,  11, 6,  2,  10, 8,  6, 7,  9, 8,  1};
  for (int i = 0; i < sphere.subdivisions; ++i) triangles = Subdivide(triangles, &directions);
  Mesh mesh{.name = "icosphere", .triangles = std::move(triangles)};
  PlaceVertices(sphere.center, sphere.radius, std::move(directions), &mesh);
  return mesh;
}

Mesh MakeMesh(const UvSphere& sphere) {
  const auto segments = static_cast<uint32_t>(sphere.segments);
  const auto rings = static_cast<uint32_t>(sphere.rings);
  Mesh mesh{.name = "uv_sphere"};
  std::vector<Vec3d> directions;
  directions.reserve(size_t{segments + 1} * (rings + 1));
  mesh.uvs.reserve(directions.capacity());
  for (uint32_t ring = 0; ring <= rings; ++ring) {
    const double v = static_cast<double>(ring) / rings;
    // Exact at the poles and at the seam, so that the positions there coincide.
    const double y = ring == rings ? 1 : -std::cos(v * std::numbers::pi);
    const double around = ring == 0 || ring == rings ? 0 : std::sin(v * std::numbers::pi);
    for (uint32_t segment = 0; segment <= segments; ++segment) {
      const double phi = 2 * std::numbers::pi * (segment % segments) / segments;
      directions.emplace_back(around * std::cos(phi), y, -around * std::sin(phi));
      // A pole has a vertex for each of its triangles, in the middle of their longitudes.
      const double to_middle = ring == 0 || ring == rings ? 0.5 : 0;
      mesh.uvs.emplace_back((segment + to_middle) / segments, v);
    }
  }
  const auto vertex = [&](uint32_t ring, uint32_t segment) {
    return ring * (segments + 1) + segment;
  };
  for (uint32_t ring = 0; ring < rings; ++ring) {
    for (uint32_t segment = 0; segment < segments; ++segment) {
      const uint32_t a = vertex(ring, segment), b = vertex(ring, segment + 1);
      const uint32_t c = vertex(ring + 1, segment + 1), d = vertex(ring + 1, segment);
      // A segment's triangle at a pole uses the pole's vertex at the segment's left.
      if (ring > 0) mesh.triangles.insert(mesh.triangles.end(), {a, b, ring + 1 < rings ? c : d});
      if (ring + 1 < rings) mesh.triangles.insert(mesh.triangles.end(), {a, c, d});
    }
  }
  PlaceVertices(sphere.center, sphere.radius, std::move(directions), &mesh);
  return mesh;
}

}  // namespace nacre
