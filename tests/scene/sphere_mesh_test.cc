// SPDX-License-Identifier: Apache-2.0
// Spheres as meshes: closed, right side out, with the sphere's own normals and uvs.
#include "scene/sphere_mesh.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "catch.h"
#include "scene/mesh.h"

namespace nacre {
namespace {

const Vec3d kCenter(1, 2, -3);
constexpr double kRadius = 2.5;

// The largest difference of a normal from the direction of its position from the centre.
double NormalError(const Mesh& mesh) {
  double error = 0;
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3d radial = (mesh.positions[i] - kCenter).normalized();
    error = std::max(error, (mesh.normals[i] - radial).length());
  }
  return error;
}

// Every edge is in exactly two triangles, once in each direction, positions told by place.
bool IsClosed(const Mesh& mesh) {
  std::map<std::array<double, 6>, int> edges;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Vec3d& a = mesh.positions[mesh.triangles[i]];
    const Vec3d& b = mesh.positions[mesh.triangles[i - i % 3 + (i + 1) % 3]];
    ++edges[{a.x, a.y, a.z, b.x, b.y, b.z}];
  }
  for (const auto& [edge, count] : edges) {
    const auto& [ax, ay, az, bx, by, bz] = edge;
    const auto back = edges.find({bx, by, bz, ax, ay, az});
    if (count != 1 || back == edges.end() || back->second != 1) return false;
  }
  return true;
}

bool FacesOutward(const Mesh& mesh) {
  for (size_t i = 0; i < mesh.triangles.size() / 3; ++i) {
    const Vec3d from_center = mesh.positions[mesh.triangles[3 * i]] - kCenter;
    if (!(FaceNormal(mesh, i).dot(from_center) > 0)) return false;
  }
  return true;
}

TEST_CASE("icospheres") {
  size_t faces = 20;
  for (int subdivisions = 0; subdivisions <= 5; ++subdivisions, faces *= 4) {
    const Mesh mesh = MakeMesh(Icosphere{kCenter, kRadius, subdivisions});
    CHECK(mesh.triangles.size() == 3 * faces);
    CHECK(mesh.positions.size() == faces / 2 + 2);  // Euler's formula
    CHECK(NormalError(mesh) < 1e-15);
    CHECK(IsClosed(mesh));
    CHECK(FacesOutward(mesh));
  }
  CHECK(MakeMesh(Icosphere{.subdivisions = 7}).triangles.size() == 3 * size_t{327680});
}

TEST_CASE("averaged normals of an icosphere are nearly radial") {
  // Exactly so at the icosahedron's corners by symmetry; elsewhere neighbours differ a little.
  Mesh mesh = MakeMesh(Icosphere{kCenter, kRadius, 0});
  for (const auto weighting :
       {NormalWeighting::kAngle, NormalWeighting::kArea, NormalWeighting::kUniform}) {
    ComputeNormals(weighting, 180, &mesh);
    CHECK(NormalError(mesh) < 1e-15);
  }
}

TEST_CASE("UV spheres") {
  for (const auto& [segments, rings] : {std::pair(3, 2), std::pair(16, 9), std::pair(64, 33)}) {
    const Mesh mesh = MakeMesh(UvSphere{kCenter, kRadius, segments, rings});
    CHECK(mesh.triangles.size() == 3 * static_cast<size_t>(segments * (2 * rings - 2)));
    CHECK(NormalError(mesh) < 1e-15);
    CHECK(IsClosed(mesh));
    CHECK(FacesOutward(mesh));
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
      const Vec3d& n = mesh.normals[i];
      const auto [u, v] = mesh.uvs[i];
      CHECK(std::abs(v - std::acos(std::max(-n.y, -1.0)) / std::numbers::pi) < 1e-7);  // acos
      if (std::abs(n.y) == 1) continue;
      const double phi = 2 * std::numbers::pi * u;
      const Vec3d across(std::cos(phi), 0, -std::sin(phi));
      CHECK((Vec3d(n.x, 0, n.z).normalized() - across).length() < 1e-14);
    }
  }
}

TEST_CASE("uvs grow to the right and up, seen from outside, over the seam too") {
  const Mesh mesh = MakeMesh(UvSphere{kCenter, kRadius, 12, 6});
  for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const Vec2d a = mesh.uvs[mesh.triangles[i]];
    const Vec2d ab = mesh.uvs[mesh.triangles[i + 1]] - a, ac = mesh.uvs[mesh.triangles[i + 2]] - a;
    CHECK(ab.cross(ac) > 0);
    CHECK(std::max(std::abs(ab.x), std::abs(ac.x)) < 1.01 / 12);
  }
}

}  // namespace
}  // namespace nacre
