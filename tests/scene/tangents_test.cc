// SPDX-License-Identifier: Apache-2.0
// MikkTSpace's tangents against the definition, followed by brute force.
#include "scene/tangents.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "catch.h"
#include "scene/mesh.h"
#include "scene/pair_edges.h"
#include "scene/sphere_mesh.h"

namespace nacre {
namespace {

Tangent At(const CornerTangents& made, size_t corner) {
  return made.tangents.at(made.corners.at(corner));
}

CornerTangents Make(const Mesh& mesh, int threads = 1) {
  return MakeTangents(mesh, mesh.uvs, {}, threads);
}

// The definition, corner by corner and without any table: all triangles that a walk over shared
// edges around the corner's vertex reaches, mirrored ones left out. Of triangles that all have an
// area in the texture, on edges of two triangles at most.
class BruteForce {
 public:
  explicit BruteForce(const Mesh& mesh) : mesh_(mesh) {}

  Tangent At(size_t corner) const {
    std::vector<size_t> reached = {corner};
    for (size_t i = 0; i < reached.size(); ++i) {
      for (size_t other = 0; other < mesh_.triangles.size(); ++other) {
        if (!Same(other, corner) || Side(other) != Side(corner)) continue;
        if (!SharesEdge(reached[i], other)) continue;
        if (std::find(reached.begin(), reached.end(), other) == reached.end()) {
          reached.push_back(other);
        }
      }
    }
    Vec3d sum(0, 0, 0);
    for (const size_t member : reached) {
      const Vec3d n = Normal(corner);
      const auto flat = [&](const Vec3d& v) { return v - n * v.dot(n); };
      const Vec3d a = flat(Position(Next(member)) - Position(member));
      const Vec3d b = flat(Position(Next(Next(member))) - Position(member));
      const double angle = std::atan2(a.cross(b).length(), a.dot(b));
      sum += flat(Gradient(member)).normalized() * angle;
    }
    return {sum.normalized(), Side(corner)};
  }

 private:
  static size_t Next(size_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  Vec3d Position(size_t corner) const { return mesh_.positions[mesh_.triangles[corner]]; }
  Vec2d Uv(size_t corner) const { return mesh_.uvs[mesh_.triangles[corner]]; }
  Vec3d Normal(size_t corner) const {
    return HasSmoothNormals(mesh_) ? mesh_.normals[mesh_.triangles[corner]]
                                   : FaceNormal(mesh_, corner / 3);
  }
  bool Same(size_t a, size_t b) const {
    return Position(a) == Position(b) && Uv(a) == Uv(b) && Normal(a) == Normal(b);
  }
  // Both are corners at the same vertex: one's outgoing edge is the other's incoming one.
  bool SharesEdge(size_t a, size_t b) const {
    return Same(Next(a), Next(Next(b))) || Same(Next(b), Next(Next(a)));
  }
  double Side(size_t corner) const {
    const size_t first = corner - corner % 3;
    const Vec2d a = Uv(first + 1) - Uv(first), b = Uv(first + 2) - Uv(first);
    return a.x * b.y - a.y * b.x > 0 ? 1 : -1;
  }
  // dP/du, of any length: the edges' combination along which v stays.
  Vec3d Gradient(size_t corner) const {
    const Vec2d a = Uv(Next(corner)) - Uv(corner), b = Uv(Next(Next(corner))) - Uv(corner);
    const Vec3d p = Position(Next(corner)) - Position(corner);
    const Vec3d q = Position(Next(Next(corner))) - Position(corner);
    return (p * b.y - q * a.y) * (a.x * b.y - a.y * b.x > 0 ? 1 : -1);
  }

  const Mesh& mesh_;
};

void CheckAgainstBruteForce(const Mesh& mesh) {
  const CornerTangents made = Make(mesh);
  const BruteForce brute(mesh);
  for (size_t corner = 0; corner < mesh.triangles.size(); ++corner) {
    CAPTURE(corner);
    const Tangent got = At(made, corner), expected = brute.At(corner);
    // Sums of six unit vectors in another order, divided by a length of at least 0.1.
    CHECK((got.direction - expected.direction).length() < 1e-13);
    CHECK(got.sign == expected.sign);
  }
}

// A square of two triangles in the plane z = 0, whose u grows to +x and v to +y.
Mesh Square() {
  Mesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
  mesh.normals.assign(4, Vec3d(0, 0, 1));
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {0, 1, 2, 0, 2, 3};
  return mesh;
}

// Hills of n x n squares. Texture coordinates are uneven and, from the middle on, mirrored; so that
// corners fold, some vertices are given twice.
Mesh Hills(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uneven(-0.2, 0.2);
  Mesh mesh;
  for (int y = 0; y <= n; ++y) {
    for (int x = 0; x <= n; ++x) {
      mesh.positions.emplace_back(x + uneven(random), y + uneven(random), 3 * uneven(random));
      mesh.uvs.emplace_back(std::min(x, n - x) + uneven(random), y + uneven(random));
    }
  }
  const auto at = [&](int x, int y) { return static_cast<uint32_t>(y * (n + 1) + x); };
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const uint32_t corners[4] = {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)};
      for (const int k : {0, 1, 2, 0, 2, 3}) mesh.triangles.push_back(corners[k]);
    }
  }
  ComputeNormals(NormalWeighting::kAngle, 180, &mesh);
  for (size_t corner = 0; corner < mesh.triangles.size(); corner += 7) {
    const uint32_t vertex = mesh.triangles[corner];
    mesh.triangles[corner] = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.push_back(Vec3d(mesh.positions[vertex]));
    mesh.normals.push_back(Vec3d(mesh.normals[vertex]));
    mesh.uvs.push_back(Vec2d(mesh.uvs[vertex]));
  }
  return mesh;
}

// Cuts the texture, not the surface: from x on, triangles have vertices of their own, at the same
// places and with the same normals, whose coordinates are turned by a quarter.
void CutTexture(double x, Mesh* mesh) {
  std::map<uint32_t, uint32_t> beyond;  // by the vertex on this side
  for (size_t first = 0; first < mesh->triangles.size(); first += 3) {
    uint32_t* const corners = &mesh->triangles[first];
    if (mesh->positions[corners[0]].x < x || mesh->positions[corners[1]].x < x) continue;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t vertex = corners[k];
      const auto [copy, is_new] =
          beyond.try_emplace(vertex, static_cast<uint32_t>(mesh->positions.size()));
      corners[k] = copy->second;
      if (!is_new) continue;
      mesh->positions.push_back(Vec3d(mesh->positions[vertex]));
      mesh->normals.push_back(Vec3d(mesh->normals[vertex]));
      mesh->uvs.emplace_back(-mesh->uvs[vertex].y, mesh->uvs[vertex].x);
    }
  }
}

TEST_CASE("tangents point along growing u, and the sign says where v grows") {
  Mesh mesh = Square();
  const CornerTangents made = Make(mesh);
  for (size_t corner = 0; corner < 6; ++corner) {
    CHECK(At(made, corner).direction == Vec3d(1, 0, 0));
    CHECK(At(made, corner).sign == 1);
  }
  for (Vec2d& uv : mesh.uvs) uv.x = -uv.x;
  const CornerTangents mirrored = Make(mesh);
  for (size_t corner = 0; corner < 6; ++corner) {
    CHECK(At(mirrored, corner).direction == Vec3d(-1, 0, 0));
    CHECK(At(mirrored, corner).sign == -1);
  }
}

TEST_CASE("tangents are those of the definition") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    Mesh mesh = Hills(8, seed);
    CheckAgainstBruteForce(mesh);
    mesh.interpolation = Interpolation::kFaceted;  // each face has normals of its own
    CheckAgainstBruteForce(mesh);
  }
}

TEST_CASE("tangents of the two sides of a seam in the texture are not averaged") {
  Mesh mesh = Hills(8, 1);
  CutTexture(2.5, &mesh);
  CheckAgainstBruteForce(mesh);
  mesh.interpolation = Interpolation::kFaceted;
  CheckAgainstBruteForce(mesh);
  // Nor those of vertices that coordinates v alone, or u alone, tell apart: two squares side by
  // side, the second's texture turned.
  for (const Vec2d& apart : {Vec2d(0, 5), Vec2d(5, 0)}) {
    Mesh squares = Square();
    for (size_t i = 0; i < 4; ++i) {
      squares.positions.push_back(Vec3d(squares.positions[i]) + Vec3d(1, 0, 0));
      squares.normals.emplace_back(0, 0, 1);
    }
    const Vec2d corner = Vec2d(1, 0) + apart;  // where the first square has (1, 0)
    for (const Vec2d& uv : {Vec2d(0, 0), Vec2d(0, -1), Vec2d(1, -1), Vec2d(1, 0)}) {
      squares.uvs.push_back(corner + uv);
    }
    squares.triangles.insert(squares.triangles.end(), {4, 5, 6, 4, 6, 7});
    const CornerTangents made = Make(squares);
    for (size_t k = 0; k < 6; ++k) {
      CHECK(At(made, k).direction == Vec3d(1, 0, 0));
      CHECK(At(made, 6 + k).direction == Vec3d(0, 1, 0));
    }
  }
}

TEST_CASE("tangents do not depend on threads, nor on how vertices are shared") {
  const Mesh mesh = Hills(40, 4);
  const CornerTangents made = Make(mesh, 1), by_four = Make(mesh, 4);
  CHECK(made.corners == by_four.corners);
  Mesh soup = mesh;
  soup.positions.clear();
  soup.normals.clear();
  soup.uvs.clear();
  for (size_t corner = 0; corner < mesh.triangles.size(); ++corner) {
    soup.positions.push_back(mesh.positions[mesh.triangles[corner]]);
    soup.normals.push_back(mesh.normals[mesh.triangles[corner]]);
    soup.uvs.push_back(mesh.uvs[mesh.triangles[corner]]);
    soup.triangles[corner] = static_cast<uint32_t>(corner);
  }
  const CornerTangents of_soup = Make(soup);
  for (size_t corner = 0; corner < mesh.triangles.size(); ++corner) {
    CHECK(At(made, corner).direction == At(by_four, corner).direction);
    CHECK(At(made, corner).direction == At(of_soup, corner).direction);
    CHECK(At(made, corner).sign == At(of_soup, corner).sign);
  }
}

TEST_CASE("a sphere's tangents go along its parallels") {
  for (const int segments : {16, 32, 64}) {
    const Mesh mesh = MakeMesh(UvSphere{Vec3d(0), 1, segments, segments / 2});
    const CornerTangents made = Make(mesh);
    double worst = 0;
    for (size_t corner = 0; corner < mesh.triangles.size(); ++corner) {
      const Vec3d p = mesh.positions[mesh.triangles[corner]];
      const double u = mesh.uvs[mesh.triangles[corner]].x;
      // Within 60 degrees of the equator; at the seam half of the faces are missing. Elsewhere
      // those of one vertex are even on both sides of its meridian.
      if (std::abs(p.y) > 0.87 || u == 0 || u == 1) continue;
      const Vec3d east = Vec3d(0, 1, 0).cross(p).normalized();
      worst = std::max(worst, At(made, corner).direction.cross(east).length());
      CHECK(At(made, corner).sign == 1);
    }
    // Edges as long as 1/10 of a radian at least, of coordinates that were rounded by 2^-53.
    CHECK(worst < 10 * 0x1p-50);
  }
}

TEST_CASE("a triangle without an area in the texture goes along with its neighbours") {
  // A strip of three squares; the middle one shows one column of the texture.
  Mesh mesh;
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 2; ++y) {
      mesh.positions.emplace_back(x, y, 0);
      mesh.uvs.emplace_back(x < 2 ? x : x - 1, y);
    }
  }
  mesh.normals.assign(8, Vec3d(0, 0, 1));
  for (uint32_t x = 0; x < 3; ++x) {
    const uint32_t a = 2 * x;
    for (const uint32_t corner : {a, a + 2, a + 3, a, a + 3, a + 1}) {
      mesh.triangles.push_back(corner);
    }
  }
  const CornerTangents made = Make(mesh);
  for (size_t corner = 0; corner < mesh.triangles.size(); ++corner) {
    CHECK(At(made, corner).direction == Vec3d(1, 0, 0));
    CHECK(At(made, corner).sign == 1);
  }
  // Nothing has an area: no tangent anywhere.
  for (Vec2d& uv : mesh.uvs) uv = Vec2d(0.25, 0.5);
  const CornerTangents none = Make(mesh);
  for (size_t corner = 0; corner < mesh.triangles.size(); ++corner) {
    CHECK(At(none, corner).direction == Vec3d(0, 0, 0));
  }
}

TEST_CASE("edges of three triangles, and triangles without an area, have tangents or none") {
  Mesh mesh = Square();
  mesh.positions.emplace_back(0.5, 0.5, 1);
  mesh.normals.emplace_back(0, 0, 1);
  mesh.uvs.emplace_back(0.5, 2);
  mesh.triangles.insert(mesh.triangles.end(), {0, 2, 4, 1, 1, 2, 0, 0, 0});
  const CornerTangents made = Make(mesh);
  REQUIRE(made.corners.size() == mesh.triangles.size());
  for (size_t corner = 0; corner < mesh.triangles.size(); ++corner) {
    const double length = At(made, corner).direction.length();
    CHECK((length == 0 || std::abs(length - 1) < 1e-15));
  }
}

TEST_CASE("transforms that rotate alike share tangents, however they scale") {
  const UvRows plain, mirrored{{-1, 0}, {0, 1}}, turned{{0, 1}, {-1, 0}};
  for (const double scale : {0.25, 1.0, 3.0, 1e-3, 1e4}) {
    CHECK(RowsOfSameTangents({{scale, 0}, {0, 7 * scale}}) == plain);
    CHECK(RowsOfSameTangents({{scale, 0.5}, {0, scale}}) == plain);  // v' grows slantwise
    CHECK(RowsOfSameTangents({{-scale, 0}, {0, scale}}) == mirrored);
    CHECK(RowsOfSameTangents({{0, scale}, {-scale, 0}}) == turned);
  }
  CHECK(!(RowsOfSameTangents({{1, 0}, {0.5, 1}}) == plain));
  // Theirs are those of the transform itself.
  const Mesh mesh = Hills(6, 5);
  for (const UvRows& rows : {UvRows{{2, 0}, {0, 3}}, UvRows{{0.6, -0.8}, {1.6, 1.2}},
                             UvRows{{1, 0.5}, {0.25, -2}}, UvRows{{1, 2}, {2, 4}}}) {
    const UvRows same = RowsOfSameTangents(rows);
    const CornerTangents made = MakeTangents(mesh, mesh.uvs, same, 1);
    const CornerTangents expected = MakeTangents(mesh, mesh.uvs, rows, 1);
    for (size_t corner = 0; corner < mesh.triangles.size(); ++corner) {
      // Two roundings of unit directions over the least area in the texture, 0.1.
      CHECK((At(made, corner).direction - At(expected, corner).direction).length() < 1e-13);
      CHECK(At(made, corner).sign == At(expected, corner).sign);
    }
  }
}

TEST_CASE("pairing the triangles on one edge takes steps in proportion to them") {
  constexpr size_t kEdges = 1'000'000;
  std::mt19937 random(1);
  std::vector<bool> mixed(kEdges);
  for (size_t i = 0; i < kEdges; ++i) mixed[i] = random() % 2 == 0;
  const std::function<bool(size_t)> directions[] = {[](size_t) { return true; },
                                                    [](size_t) { return false; },
                                                    [](size_t i) { return i < kEdges / 2; },
                                                    [](size_t i) { return i % 2 == 0; },
                                                    [](size_t i) { return i == kEdges - 1; },
                                                    [&](size_t i) { return mixed[i]; }};
  for (const auto& rises : directions) {
    size_t steps = 0, pairs = 0, ups = 0;
    std::vector<bool> paired(kEdges);
    for (size_t i = 0; i < kEdges; ++i) ups += rises(i) ? 1 : 0;
    PairEdges(
        kEdges,
        [&](size_t i) {
          ++steps;
          return rises(i);
        },
        [&](size_t up, size_t down) {
          ++pairs;
          if (!rises(up) || rises(down) || paired[up] || paired[down]) FAIL("not a pair");
          paired[up] = paired[down] = true;
        });
    CHECK(pairs == std::min(ups, kEdges - ups));
    CHECK(steps <= 2 * kEdges);
  }
}

TEST_CASE("triangles on one edge are neighbours two by two, in their order") {
  // Three that go up the edge from 0 to 1, and two that go down.
  std::vector<std::pair<size_t, size_t>> pairs;
  const bool rises[] = {true, true, false, true, false};
  PairEdges(
      5, [&](size_t i) { return rises[i]; },
      [&](size_t up, size_t down) { pairs.emplace_back(up, down); });
  CHECK(pairs == std::vector<std::pair<size_t, size_t>>{{0, 2}, {1, 4}});
}

TEST_CASE("a fan of many triangles on one edge has a tangent for each of them") {
  // All go the same way along the edge, so none is a neighbour of another.
  constexpr uint32_t kTriangles = 200'000;
  Mesh mesh{.positions = {{0, 0, 0}, {0, 0, 1}}, .uvs = {{0, 0}, {0, 1}}};
  for (uint32_t i = 0; i < kTriangles; ++i) {
    const double turn = 2 * M_PI * i / kTriangles;
    mesh.positions.emplace_back(std::cos(turn), std::sin(turn), 0);
    mesh.uvs.emplace_back(1, 0);
    for (const uint32_t corner : {0u, 1u, 2 + i}) mesh.triangles.push_back(corner);
  }
  mesh.normals.assign(mesh.positions.size(), Vec3d(0, 0, 1));
  const CornerTangents made = Make(mesh);
  for (uint32_t i = 0; i < kTriangles; i += 997) {
    const Vec3d out = mesh.positions[2 + i];
    CHECK((At(made, size_t{3} * i).direction - out).length() < 1e-15);
  }
}

TEST_CASE("tangents follow the texture's transform") {
  const Mesh mesh = Hills(6, 5);
  for (const UvRows& rows : {UvRows{{2, 0}, {0, 2}}, UvRows{{-1, 0}, {0, 3}},
                             UvRows{{0.6, -0.8}, {0.8, 0.6}}, UvRows{{1, 0.5}, {0.25, -2}}}) {
    std::vector<Vec2d> transformed;
    for (const Vec2d& uv : mesh.uvs) {
      transformed.emplace_back(rows.u_row.dot(uv), rows.v_row.dot(uv));
    }
    const CornerTangents made = MakeTangents(mesh, mesh.uvs, rows, 1);
    const CornerTangents expected = MakeTangents(mesh, transformed, {}, 1);
    for (size_t corner = 0; corner < mesh.triangles.size(); ++corner) {
      // The products that the transform rounds: a few 2^-53 over areas of 0.1.
      CHECK((At(made, corner).direction - At(expected, corner).direction).length() < 1e-12);
      CHECK(At(made, corner).sign == At(expected, corner).sign);
    }
  }
  CHECK(At(MakeTangents(mesh, mesh.uvs, {{0, 0}, {0, 0}}, 1), 0).direction == Vec3d(0, 0, 0));
}

TEST_CASE("tangents that a file has turn with the texture as those that are made do") {
  Mesh mesh = Square();
  mesh.tangents.assign(4, {Vec3d(1, 0, 0), 1});
  for (const UvRows& rows : {UvRows{{3, 0}, {0, 2}}, UvRows{{-1, 0}, {0, 1}},
                             UvRows{{1, 0}, {0, -1}}, UvRows{{0.6, -0.8}, {0.8, 0.6}}}) {
    const CornerTangents turned = RotateTangents(mesh, rows);
    const CornerTangents made = MakeTangents(mesh, mesh.uvs, rows, 1);
    for (size_t corner = 0; corner < 6; ++corner) {
      CHECK((At(turned, corner).direction - At(made, corner).direction).length() < 1e-15);
      CHECK(At(turned, corner).sign == At(made, corner).sign);
    }
  }
  CHECK(At(RotateTangents(mesh, {}), 0).direction == Vec3d(1, 0, 0));
}

TEST_CASE("tangents are transformed with their mesh, and mirrored with it") {
  Mesh mesh = Hills(4, 6);
  const CornerTangents before = Make(mesh);
  // One tangent per position, as files have them: of a mesh without mirrored halves.
  for (Vec2d& uv : mesh.uvs) uv.x = std::abs(uv.x);
  mesh.tangents.resize(mesh.positions.size());
  for (size_t corner = 0; corner < mesh.triangles.size(); ++corner) {
    mesh.tangents[mesh.triangles[corner]] = At(before, corner);
  }
  const std::vector<Tangent> given = mesh.tangents;
  const std::vector<Vec3d> normals = mesh.normals;
  Transform mirror;
  mirror.scale = Vec3d(-1, 1, 1);
  ApplyTransform(mirror, &mesh);
  for (size_t i = 0; i < given.size(); ++i) {
    const auto& [direction, sign] = mesh.tangents[i];
    const Vec3d bitangent = normals[i].cross(given[i].direction) * given[i].sign;
    const Vec3d got = mesh.normals[i].cross(direction) * sign;
    CHECK((direction - given[i].direction * Vec3d(-1, 1, 1)).length() < 1e-15);
    CHECK((got - bitangent * Vec3d(-1, 1, 1)).length() < 1e-15);
  }
  ComputeNormals(NormalWeighting::kAngle, 180, &mesh);
  CHECK(mesh.tangents.empty());
}

}  // namespace
}  // namespace nacre
