// SPDX-License-Identifier: Apache-2.0
// tests/light/mesh_outline_test.cc: which meshes are recognised to have one convex outline.
#include "light/mesh_outline.h"

#include "catch.h"

namespace nacre {
namespace {

struct Triangles {
  std::vector<Vec3d> positions;
  std::vector<uint32_t> indices;
  bool is_flat;

  MeshOutline Make() const { return MakeMeshOutline(positions, indices, Vec3d(1, 2, 3), is_flat); }
};

Triangles Cube() {
  Triangles cube{{}, {}, false};
  for (uint32_t i = 0; i < 8; ++i) {
    cube.positions.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  }
  cube.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  return cube;
}

Triangles Quad() {
  return {{{0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {0, 1, 1}}, {0, 1, 2, 0, 2, 3}, true};
}

TEST_CASE("solids and polygons have each corner, face and edge once") {
  const MeshOutline cube = Cube().Make();
  CHECK(cube.corners.size() == 8);
  CHECK(cube.corners[0] == Vec3d(-2, -3, -4));
  CHECK(cube.faces.size() == 12);
  REQUIRE(cube.edges.size() == 18);
  for (const OutlineEdge& edge : cube.edges) {
    REQUIRE(edge.right != kNoFace);
    CHECK(edge.left != edge.right);
  }
  const MeshOutline quad = Quad().Make();
  REQUIRE(quad.edges.size() == 5);
  size_t border = 0;
  for (const OutlineEdge& edge : quad.edges) border += edge.right == kNoFace ? 1 : 0;
  CHECK(border == 4);
  CHECK(quad.faces[0].cross == Vec3d(0, 0, 2));
}

TEST_CASE("corners at one place are one, and triangles without an area none") {
  Triangles quad = Quad();
  quad.positions.push_back(quad.positions[0]);
  quad.positions.push_back(quad.positions[2]);
  quad.indices = {0, 1, 2, 4, 5, 3, 1, 1, 2};
  const MeshOutline outline = quad.Make();
  CHECK(outline.corners.size() == 4);
  CHECK(outline.edges.size() == 5);
}

TEST_CASE("other meshes have no outline") {
  const auto none = [](const Triangles& mesh) { return mesh.Make().edges.empty(); };
  Triangles open = Cube();
  open.indices.resize(open.indices.size() - 3);
  CHECK(none(open));
  Triangles notched = Quad();
  notched.positions[3] = Vec3d(1.5, 0.25, 1);  // the quad is an arrow now
  CHECK(none(notched));
  Triangles apart = Quad();
  for (const Vec3d& p : Quad().positions) apart.positions.push_back(p + Vec3d(3, 0, 0));
  for (const uint32_t i : Quad().indices) apart.indices.push_back(i + 4);
  CHECK(none(apart));
  Triangles plate = Quad();  // with a back
  for (const uint32_t i : {0u, 2u, 1u, 0u, 3u, 2u}) plate.indices.push_back(i);
  CHECK(none(plate));
  Triangles twice = Quad();
  twice.indices.insert(twice.indices.end(), twice.indices.begin(), twice.indices.begin() + 6);
  CHECK(none(twice));
  Triangles frame{{}, {}, true};  // a square with a square hole
  for (const double r : {1.0, 2.0}) {
    for (const Vec3d& p : {Vec3d(-r, -r, 0), Vec3d(r, -r, 0), Vec3d(r, r, 0), Vec3d(-r, r, 0)}) {
      frame.positions.push_back(p);
    }
  }
  for (uint32_t i = 0; i < 4; ++i) {
    const uint32_t next = (i + 1) % 4;
    for (const uint32_t c : {i, i + 4, next + 4, i, next + 4, next}) frame.indices.push_back(c);
  }
  CHECK(none(frame));
}

}  // namespace
}  // namespace nacre
