// SPDX-License-Identifier: Apache-2.0
// tests/light/mesh_light_test.cc: triangles as one light: how they are chosen, which ones a ray
// hits, and whether they hide one another.
#include "light/mesh_light.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "catch.h"

namespace nacre {
namespace {

struct Triangles {
  std::vector<Vec3d> positions;
  std::vector<uint32_t> indices;

  MeshLight Make(const Vec3d& origin = Vec3d(0)) const {
    return MakeMeshLight(positions, indices, origin);
  }
};

// Six faces of two triangles, seen from outside.
Triangles Cube() {
  Triangles cube;
  for (uint32_t i = 0; i < 8; ++i) {
    cube.positions.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  }
  cube.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  return cube;
}

// Triangles of all sizes, here and there.
Triangles Heap(size_t count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Triangles heap;
  for (size_t i = 0; i < count; ++i) {
    const Vec3d middle{uniform(random), uniform(random), uniform(random)};
    for (uint32_t k = 0; k < 3; ++k) {
      const Vec3d way{uniform(random), uniform(random), uniform(random)};
      heap.positions.push_back(middle + way * 0.8);
      heap.indices.push_back(static_cast<uint32_t>(heap.indices.size()));
    }
  }
  return heap;
}

TEST_CASE("triangles are as probable as they are large, and those without an area never") {
  Triangles two;
  two.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 3}, {2, 0, 0}};
  two.indices = {0, 1, 2, 0, 1, 4, 0, 3, 2, 1, 1, 2};  // 1/2, nothing, 3/2, nothing
  const MeshLight light = two.Make(Vec3d(7, 8, 9));
  REQUIRE(light.triangles.size() == 2);
  const size_t large = light.triangles[0].edge_x.length() > 2 ? 0 : 1;
  CHECK(light.probabilities[large] == 0.75);
  CHECK(light.probabilities[1 - large] == 0.25);
  CHECK(light.triangles[0].corner == Vec3d(-7, -8, -9));
  // Of all numbers in [0, 1) three quarters choose it.
  size_t chosen = 0;
  for (size_t i = 0; i < 100; ++i) {
    chosen += PickIndex(light.by_area, (static_cast<double>(i) + 0.5) / 100).index == large;
  }
  CHECK(chosen == 75);
}

TEST_CASE("a ray hits the triangles that it hits one by one") {
  for (const size_t count : {1u, 5u, 300u}) {
    const MeshLight light = Heap(count).Make();
    std::mt19937 random(6);
    std::uniform_real_distribution<double> uniform(-1, 1);
    size_t met = 0;
    std::vector<MeshLightHit> hits;
    for (int i = 0; i < 2000; ++i) {
      const Vec3d point = Vec3d{uniform(random), uniform(random), uniform(random)} * 2;
      Vec3d direction{uniform(random), uniform(random), uniform(random)};
      if (i % 3 == 0) direction = Vec3d(0, 0, i % 2 == 0 ? 1 : -1);
      direction.normalize();
      FindMeshLightHits(light, point, direction, &hits);
      std::vector<bool> found(light.triangles.size());
      for (const MeshLightHit& hit : hits) {
        REQUIRE(!found[hit.triangle]);
        found[hit.triangle] = true;
        const TriangleLight<double>& t = light.triangles[hit.triangle];
        const Vec3d normal = (t.edge_x % t.edge_y).normalized();
        REQUIRE(std::abs(normal ^ (point + direction * hit.t - t.corner)) <= 1e-12);
      }
      for (size_t k = 0; k < light.triangles.size(); ++k) {
        TriangleLight<double> seen = light.triangles[k];
        seen.corner -= point;
        REQUIRE(found[k] == (LightPdf(seen, direction) > 0));
      }
      met += hits.size();
    }
    CHECK(met > count);
  }
}

TEST_CASE("rays along the sides of boxes meet what lies in them") {
  const MeshLight cube = Cube().Make();
  std::vector<MeshLightHit> hits;
  const auto count = [&](const Vec3d& point, const Vec3d& direction) {
    FindMeshLightHits(cube, point, direction, &hits);
    return hits.size();
  };
  CHECK(count({0.3, 0.2, -5}, {0, 0, 1}) == 2);
  CHECK(count({0.3, 0.2, 5}, {0, 0, 1}) == 0);
  CHECK(count({0.3, 0.2, 0}, {0, 0, 1}) == 1);
  CHECK(count({1, 0.2, -5}, {0, 0, 1}) >= 2);  // in a face's plane: through two edges
  CHECK(count({1.001, 0.2, -5}, {0, 0, 1}) == 0);
}

TEST_CASE("meshes of which no front hides another are known") {
  const auto shape = [](const Triangles& t) {
    const MeshLight light = t.Make({1, 2, 3});
    return std::pair(light.is_convex, light.is_flat);
  };
  Triangles quad;
  quad.positions = {{0, 0, 0.3}, {0.7, 0, 0.3}, {0.7, 0.9, 0.3}, {0, 0.9, 0.3}};
  quad.indices = {0, 1, 2, 0, 2, 3};
  CHECK(shape(quad) == std::pair(true, true));
  CHECK(shape(Cube()) == std::pair(true, false));
  Triangles inside_out = Cube();
  for (size_t i = 0; i < inside_out.indices.size(); i += 3) {
    std::swap(inside_out.indices[i], inside_out.indices[i + 1]);
  }
  CHECK(shape(inside_out) == std::pair(false, false));
  Triangles valley = quad;
  valley.positions[3].z += 1e-3;  // its fronts see each other
  CHECK(shape(valley) == std::pair(false, false));
  Triangles ridge = quad;
  ridge.positions[3].z -= 1e-3;
  CHECK(shape(ridge) == std::pair(true, false));
  CHECK(shape(Heap(kMaxClosedFormTriangles + 1)) == std::pair(false, false));
}

}  // namespace
}  // namespace nacre
