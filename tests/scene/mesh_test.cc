// SPDX-License-Identifier: Apache-2.0
// Face normals, smooth normals, transforms and polygons.
#include "scene/mesh.h"

#include <array>
#include <cmath>
#include <numbers>

#include "catch.h"
#include "scene/polygon.h"

namespace nacre {
namespace {

// A cube of two triangles a face, its diagonals in no particular order.
Mesh Cube() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  }
  mesh.triangles = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                    2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  return mesh;
}

double Volume(const Mesh& mesh) {
  double volume = 0;
  for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
    volume += mesh.positions[mesh.triangles[i]].dot(
        mesh.positions[mesh.triangles[i + 1]].cross(mesh.positions[mesh.triangles[i + 2]]));
  }
  return volume / 6;
}

std::vector<Vec3d> NormalsOf(Mesh mesh, NormalWeighting weighting = NormalWeighting::kAngle) {
  ComputeNormals(weighting, 180, &mesh);
  return mesh.normals;
}

TEST_CASE("face normals follow the right hand and do not know scale") {
  for (const double size : {1e-12, 1.0, 1e12}) {
    Mesh mesh{.positions = {{0, 0, 0}, {size, 0, 0}, {0, size, 0}},
              .triangles = {0, 1, 2, 0, 2, 1, 0, 1, 1}};
    CHECK(FaceNormal(mesh, 0) == Vec3d(0, 0, 1));
    CHECK(FaceNormal(mesh, 1) == Vec3d(0, 0, -1));
    CHECK(FaceNormal(mesh, 2) == Vec3d(0, 0, 0));
  }
}

TEST_CASE("a face in the plane A x + B y + C z = D has the normal (A, B, C) / |(A, B, C)|") {
  for (const Vec3d& plane : {Vec3d(1, 2, 3), Vec3d(-7, 11, 2), Vec3d(1, 1, 1), Vec3d(3, -4, 1000),
                             Vec3d(0.5, 1023, -2), Vec3d(-5, 1, 0.125)}) {
    // Across (B, -A, 0) x (0, C, -B) = B (A, B, C), all without rounding.
    const Vec3d along(plane.y, -plane.x, 0), across(0, plane.z, -plane.y), place(64, -32, 16);
    Mesh mesh{.positions = {place, place + along, place + across}, .triangles = {0, 1, 2}};
    const Vec3d expected = plane * (plane.y > 0 ? 1 : -1) / plane.length();
    const Vec3d normal = FaceNormal(mesh, 0);
    for (int c = 0; c < 3; ++c) {
      CHECK(std::abs(normal[c] - expected[c]) <= 4 * 0x1p-53 * std::abs(expected[c]));
    }
    CHECK(std::abs(normal.length() - 1) <= 4 * 0x1p-53);
  }
}

TEST_CASE("smooth normals do not depend on how faces are cut") {
  // Weighting by count or by area would pull them towards faces that have two triangles at the
  // corner.
  const Mesh cube = Cube();
  const std::vector<Vec3d> normals = NormalsOf(cube);
  for (size_t i = 0; i < 8; ++i) {
    // Sums of three right angles, a few roundings each.
    CHECK((normals[i] - cube.positions[i] / std::sqrt(3)).length() < 1e-15);
  }
}

TEST_CASE("normals weighted by area, and equally") {
  // Three faces of a box's corner, of areas 1 : 2 : 3 along x, y, z, the second one cut in two.
  Mesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 3, 0}, {0, 0, 2}, {0.5, 0, 1}},
            .triangles = {0, 2, 1, 0, 1, 4, 0, 4, 3, 0, 3, 2}};
  const Vec3d by_area = -Vec3d(6, 2, 3).normalized();  // of the triangles: 3 x 2, 2 x 1, 1 x 3
  CHECK((NormalsOf(mesh, NormalWeighting::kArea)[0] - by_area).length() < 1e-15);
  const Vec3d by_count = -Vec3d(1, 2, 1).normalized();
  CHECK((NormalsOf(mesh, NormalWeighting::kUniform)[0] - by_count).length() < 1e-15);
  const Vec3d by_angle = -Vec3d(1, 1, 1).normalized();
  CHECK((NormalsOf(mesh, NormalWeighting::kAngle)[0] - by_angle).length() < 1e-15);
}

TEST_CASE("faces are not averaged over creases") {
  for (const double angle : {0.0, 89.0, 91.0, 179.9}) {
    Mesh mesh = Cube();
    ComputeNormals(NormalWeighting::kUniform, angle, &mesh);
    REQUIRE(mesh.normals.size() == mesh.positions.size());
    const bool creased = angle < 90;
    CHECK(mesh.positions.size() == (creased ? 24 : 8));
    CHECK(Volume(mesh) == 8);
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
      const double cosine = mesh.normals[mesh.triangles[i]].dot(FaceNormal(mesh, i / 3));
      CHECK((cosine > 1 - 1e-15) == creased);
    }
  }
}

TEST_CASE("a crease on one side of a vertex does not part the faces that go round the other") {
  // A book of 60 degrees on a table: the pages meet at their spine alone.
  Mesh tent{.positions = {{0, 0, 0}, {1, 0, 0}, {0.5, 0, 1}, {1, 1, 0}}};
  tent.triangles = {0, 1, 2, 0, 3, 1};  // about the spine 0-1, at 90 degrees
  Mesh split = tent;
  ComputeNormals(NormalWeighting::kAngle, 60, &split);
  CHECK(split.positions.size() == 6);
  // Joined by a strip that turns in two steps of 45 degrees, they are one smooth surface.
  Mesh ridge{.positions = {{0, 0, 0},
                           {1, 0, 0},
                           {1, 0, 2},
                           {0, 0, 2},
                           {0, 1, -1},
                           {1, 1, -1},
                           {0, 2, -1},
                           {1, 2, -1}},
             .triangles = {0, 1, 2, 0, 2, 3, 4, 5, 1, 4, 1, 0, 6, 7, 5, 6, 5, 4}};
  Mesh smooth = ridge;
  ComputeNormals(NormalWeighting::kAngle, 46, &smooth);
  CHECK(smooth.positions.size() == 8);
  ComputeNormals(NormalWeighting::kAngle, 44, &ridge);
  CHECK(ridge.positions.size() == 12);
}

TEST_CASE("a seam of uvs is no crease, and a fan of many faces takes no time") {
  Mesh quad{.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 0, 0}, {1, 1, 0.5}, {0, 1, 0}},
            .uvs = {{0, 0}, {1, 0}, {1, 1}, {0.5, 0}, {0.5, 1}, {0, 1}},
            .triangles = {0, 1, 2, 3, 4, 5}};
  for (const double angle : {180.0, 80.0}) {
    Mesh mesh = quad;
    ComputeNormals(NormalWeighting::kAngle, angle, &mesh);
    CHECK(mesh.positions.size() == 6);
    CHECK(mesh.normals[0] == mesh.normals[3]);
    CHECK(mesh.normals[2] == mesh.normals[4]);
  }
  quad.uvs.clear();
  ComputeNormals(NormalWeighting::kAngle, 180, &quad);
  CHECK(quad.normals[0] != quad.normals[3]);

  Mesh fan;
  constexpr uint32_t kFaces = 200000;
  fan.positions.emplace_back(0, 0, 1);
  for (uint32_t i = 0; i < kFaces; ++i) {
    fan.positions.emplace_back(std::cos(i * 1e-5), std::sin(i * 1e-5), 0);
    if (i > 0) fan.triangles.insert(fan.triangles.end(), {0, i, i + 1});
  }
  ComputeNormals(NormalWeighting::kUniform, 0, &fan);  // every edge is a crease
  CHECK(fan.positions.size() > kFaces);
}

TEST_CASE("positions without any area around them have some unit normal") {
  Mesh mesh = Cube();
  mesh.positions.emplace_back(5, 5, 5);
  mesh.triangles.insert(mesh.triangles.end(), {8, 8, 0});
  CHECK(NormalsOf(mesh)[8] == Vec3d(0, 1, 0));
}

TEST_CASE("edges of three faces, and faces that contradict each other, have unit normals") {
  Mesh fins;  // three about the z axis, 120 degrees apart; the last one wound the other way
  fins.positions = {{0, 0, 0}, {0, 0, 1}};
  for (int i = 0; i < 3; ++i) {
    const double angle = 2 * std::numbers::pi * i / 3;
    fins.positions.emplace_back(std::cos(angle), std::sin(angle), 0.5);
  }
  fins.triangles = {0, 1, 2, 0, 1, 3, 1, 0, 4};
  for (const double crease : {180.0, 45.0, 0.0}) {
    CAPTURE(crease);
    Mesh mesh = fins;
    ComputeNormals(NormalWeighting::kAngle, crease, &mesh);
    REQUIRE(mesh.normals.size() == mesh.positions.size());
    CHECK(mesh.triangles.size() == fins.triangles.size());
    for (const Vec3d& normal : mesh.normals) {
      CHECK(std::abs(normal.length() - 1) <= 4 * 0x1p-53);
    }
    // A fin's outer corner knows no other fin.
    for (size_t t = 0; t < 3; ++t) {
      const Vec3d outer = mesh.normals[mesh.triangles[3 * t + 2]];
      CHECK((outer - FaceNormal(mesh, t)).length() <= 4 * 0x1p-53);
    }
  }
  // The same face twice, once each way: they cancel out, and some unit normal is left.
  Mesh both = fins;
  both.triangles = {0, 1, 2, 1, 0, 2};
  CHECK(NormalsOf(both)[2] == Vec3d(0, 1, 0));
}

TEST_CASE("transforms scale, rotate about x, y, z and translate") {
  const auto moved = [](const Transform& transform) {
    Mesh mesh{.positions = {{1, 2, 3}}};
    ApplyTransform(transform, &mesh);
    return mesh.positions[0];
  };
  // cos(90 degrees) is 6e-17 in double; the components are at most 3.
  constexpr double kTolerance = 1e-15;
  CHECK((moved({.rotate_deg = {90, 0, 0}}) - Vec3d(1, -3, 2)).length() < kTolerance);
  CHECK((moved({.rotate_deg = {0, 90, 0}}) - Vec3d(3, 2, -1)).length() < kTolerance);
  CHECK((moved({.rotate_deg = {0, 0, 90}}) - Vec3d(-2, 1, 3)).length() < kTolerance);
  // x first: (1, -3, 2), then y: (2, -3, -1), then z: (3, 2, -1).
  CHECK((moved({.rotate_deg = {90, 90, 90}}) - Vec3d(3, 2, -1)).length() < kTolerance);
  CHECK(moved({.translate = {10, 0, 0}, .scale = {2, 3, -1}}) == Vec3d(12, 6, -3));
}

TEST_CASE("normals stay perpendicular to a scaled surface") {
  Mesh mesh{.positions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .triangles = {0, 1, 2}};
  mesh.normals.assign(3, FaceNormal(mesh, 0));
  ApplyTransform({.translate = {0, 0, 0}, .scale = {1, 5, 0.2}, .rotate_deg = {10, 20, 30}}, &mesh);
  CHECK((mesh.normals[0] - FaceNormal(mesh, 0)).length() < 1e-15);
}

TEST_CASE("a mirrored mesh keeps its outside outside") {
  for (const Vec3d& scale : {Vec3d(-1, 1, 1), Vec3d(-1, -1, 1), Vec3d(-1, -2, -3)}) {
    Mesh mesh = Cube();
    mesh.normals = NormalsOf(mesh);
    ApplyTransform({.translate = {0, 0, 0}, .scale = scale, .rotate_deg = {0, 0, 0}}, &mesh);
    CHECK(Volume(mesh) == Approx(8 * std::abs(scale.x * scale.y * scale.z)));
    for (size_t i = 0; i < 8; ++i) CHECK(mesh.normals[i].dot(mesh.positions[i]) > 0);
  }
}

double TriangleArea(const std::vector<Vec3d>& corners, const uint32_t* triangle) {
  const Vec3d& a = corners[triangle[0]];
  return (corners[triangle[1]] - a).cross(corners[triangle[2]] - a).length() / 2;
}

// The vector area and the sum of the triangles' areas are equal only if none is turned over, and
// the latter is the polygon's only if none overlap.
void CheckTriangulation(const std::vector<Vec3d>& corners, double area) {
  std::vector<uint32_t> triangles;
  Triangulate(corners, &triangles);
  REQUIRE(triangles.size() == 3 * (corners.size() - 2));
  double sum = 0;
  Vec3d vector_area(0, 0, 0);
  for (size_t i = 0; i < triangles.size(); i += 3) {
    sum += TriangleArea(corners, &triangles[i]);
    const Vec3d& a = corners[triangles[i]];
    vector_area += (corners[triangles[i + 1]] - a).cross(corners[triangles[i + 2]] - a) / 2;
  }
  CHECK(sum == Approx(area).epsilon(1e-9));
  CHECK(vector_area.length() == Approx(area).epsilon(1e-9));
}

TEST_CASE("convex polygons become fans") {
  std::vector<uint32_t> triangles = {9};
  const std::array<Vec3d, 5> corners = {{{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {0, 2, 0}}};
  Triangulate(corners, &triangles);
  CHECK(triangles == std::vector<uint32_t>{9, 0, 1, 2, 0, 2, 3, 0, 3, 4});
}

TEST_CASE("concave polygons are cut right wherever they lie and whichever way they turn") {
  const std::vector<Vec3d> shape = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}};
  for (const Vec3d& offset :
       {Vec3d(0, 0, 0), Vec3d(10, 0, 0), Vec3d(-10, 3, 1), Vec3d(-3, -20, 7)}) {
    for (const int axis : {0, 1, 2}) {
      std::vector<Vec3d> corners;
      for (const Vec3d& p : shape) {
        const Vec3d turned(p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]);
        corners.push_back(turned + offset);
      }
      CheckTriangulation(corners, 10);
      CheckTriangulation({corners.rbegin(), corners.rend()}, 10);
    }
  }
  // A comb: every other corner is concave.
  std::vector<Vec3d> comb = {{20, -1, 0}};
  for (int i = 20; i >= 0; --i) comb.emplace_back(i, i % 2 == 0 ? 5 : 0, 0);
  comb.emplace_back(0, -1, 0);
  CheckTriangulation(comb, 20 + 10 * 5);
}

TEST_CASE("concave quads are cut along the inner diagonal") {
  CheckTriangulation({{0, 0, 0}, {2, 2, 0}, {0, 1, 0}, {-2, 2, 0}}, 2);
}

TEST_CASE("polygons without an area still give triangles") {
  std::vector<uint32_t> triangles;
  Triangulate(std::array<Vec3d, 4>{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}}, &triangles);
  CHECK(triangles.size() == 6);
  Triangulate(std::vector<Vec3d>(4, Vec3d(1, 2, 3)), &triangles);
  CHECK(triangles.size() == 12);
}

}  // namespace
}  // namespace nacre
