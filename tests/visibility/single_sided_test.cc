// SPDX-License-Identifier: Apache-2.0
// Rays through single-sided meshes against the scalar test of every triangle, and the sign of
// (e1 x e2) . direction in long double for the side.
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "catch.h"
#include "rays.h"
#include "targets.h"

namespace nacre {
namespace {

// The first and the last mesh single-sided.
Scene SidedScene(unsigned seed) {
  Scene scene = RandomShapes(seed);
  scene.materials[1].single_sided = true;
  return scene;
}

// Whether the ray comes from where the corners run counter-clockwise.
bool IsFromFront(const std::array<Vec3d, 3>& corners, const Vec3d& direction) {
  using Wide = Imath::Vec3<long double>;
  const Wide a(corners[0]), b(corners[1]), c(corners[2]);
  return (b - a).cross(c - a).dot(Wide(direction)) < 0;
}

// Calls body(primitive, t, is_front, single_sided) for each surface on the ray's line.
template <class Body>
void ForEachSide(const Scene& scene, const Ray& ray, const Body& body) {
  uint32_t primitive = 0;
  for (const Sphere& sphere : scene.spheres) {
    const auto hit =
        TestSphere(sphere.center - ray.origin, ray.direction, sphere.radius, TargetProducts());
    if (hit.hit) body(primitive, hit.t, true, false);
    ++primitive;
  }
  for (const Mesh& mesh : scene.meshes) {
    for (size_t i = 0; i < mesh.triangles.size(); i += 3, ++primitive) {
      const auto at = [&](size_t k) { return mesh.positions[mesh.triangles[i + k]]; };
      const auto hit = TestTriangle(at(0) - ray.origin, at(1) - ray.origin, at(2) - ray.origin,
                                    ray.direction, MakeShear(ray.direction), TargetProducts());
      if (!hit.hit) continue;
      const bool is_front = IsFromFront({at(0), at(1), at(2)}, ray.direction);
      CHECK(ComesFromFront(hit, ray.direction) == is_front);
      body(primitive, hit.t, is_front, scene.materials[mesh.material.index].single_sided);
    }
  }
}

TEST_CASE("rays pass through the backs of single-sided triangles, light through its own") {
  for (const unsigned seed : {1u, 2u}) {
    Scene scene = SidedScene(seed);
    std::mt19937 random(seed + 10);
    std::uniform_real_distribution<double> in(-1, 1);
    std::vector<Ray> rays(3000);
    std::vector<ShadowRay> shadows;
    int number = 0;
    for (Ray& ray : rays) {
      ray.origin = Vec3d(in(random), in(random), in(random)) * 0.8;
      ray.direction = Vec3d(in(random), in(random), in(random));
      ++number;  // some lie in a plane of the axes, and halve it
      if (number % 7 == 0) ray.direction[number % 3] = 0;
      if (number % 35 == 0) ray.direction[(number + 1) % 3] = -ray.direction[(number + 2) % 3];
      shadows.push_back({ray, 1.0, kNoPrimitive});
    }
    for (const bool culling : {true, false}) {
      CAPTURE(seed, culling);
      scene.image.culling = culling;
      ForEachTarget([&](Target) {
        std::vector<Hit> expected(rays.size());
        std::vector<bool> occluded(rays.size());
        size_t passed = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
          double nearest = std::numeric_limits<double>::infinity();
          ForEachSide(scene, rays[i], [&](uint32_t primitive, double t, bool front, bool single) {
            const bool culls = culling && single;
            nearest = std::min(nearest, t);
            if ((front || !culls) && t < expected[i].t) expected[i] = {primitive, t};
            // The light looks along the ray from its other end.
            if ((!front || !culls) && t < 1) occluded[i] = true;
          });
          passed += nearest < expected[i].t ? 1 : 0;
        }
        CHECK((passed > rays.size() / 5) == culling);
        for (const bool shells : {false, true}) {
          IntersectorSettings how;
          how.shells = shells;
          const Intersector intersector(scene, Vec3d(0), how);
          CHECK(Trace(intersector, rays) == expected);
          CHECK(Trace(intersector, rays, 7) == expected);  // other packets
          CHECK(TraceShadows(intersector, shadows) == occluded);
        }
      });
    }
  }
}

TEST_CASE(
    "a closed single-sided mesh has no gaps: all rays from outside meet it, from inside none") {
  // An octahedron of unequal axes.
  Mesh closed{.positions = {
                  {1, 0.1, 0}, {-0.9, 0, 0.2}, {0, 1.1, 0}, {0.1, -1, 0}, {0, 0, 1.2}, {0, 0, -1}}};
  for (const uint32_t x : {0u, 1u}) {
    for (const uint32_t y : {2u, 3u}) {
      for (const uint32_t z : {4u, 5u}) {
        const bool mirrored = (x + y + z) % 2 != 0;
        for (const uint32_t corner : {x, mirrored ? z : y, mirrored ? y : z}) {
          closed.triangles.push_back(corner);
        }
      }
    }
  }
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].single_sided = true;
  closed.material = {0};
  scene.meshes = {closed};
  // Through the corners and the middles of edges, where triangles meet, and from the axes.
  std::vector<Ray> inward, outward;
  for (size_t i = 0; i < closed.triangles.size(); ++i) {
    const Vec3d a = closed.positions[closed.triangles[i]];
    const Vec3d b = closed.positions[closed.triangles[i - i % 3 + (i + 1) % 3]];
    for (const Vec3d& target : {a, (a + b) / 2}) {
      // Somewhat inside of what is exactly at the silhouette.
      for (const Vec3d& eye : {Vec3d(0, 0, 3), Vec3d(3, 0, 0), Vec3d(0.3, 2.5, 1.1)}) {
        inward.push_back({eye, target * 0.9 - eye});
      }
      outward.push_back({Vec3d(0), target});
    }
  }
  // Rays start relative to the camera, no further from it than the mesh.
  const Vec3d camera(0, 0, 3);
  for (std::vector<Ray>* rays : {&inward, &outward}) {
    for (Ray& ray : *rays) ray.origin -= camera;
  }
  ForEachTarget([&](Target) {
    const Intersector intersector(scene, camera);
    for (const Hit& hit : Trace(intersector, inward)) CHECK(hit.primitive != kNoPrimitive);
    for (const Hit& hit : Trace(intersector, outward)) CHECK(hit.primitive == kNoPrimitive);
  });
}

TEST_CASE("what culls nothing keeps no list of it") {
  Scene scene = SidedScene(3);
  const auto sides = [&] { return MakeTraceGeometry(scene, Vec3d(0)).single_sided; };
  std::vector<uint8_t> expected(60, 1);
  std::fill(expected.begin() + 20, expected.begin() + 40, uint8_t{0});
  CHECK(sides() == expected);
  scene.image.culling = false;
  CHECK(sides().empty());
  scene.image.culling = true;
  scene.materials[1].single_sided = false;
  CHECK(sides().empty());
  scene.materials[0].single_sided = true;  // the mesh in the middle
  for (uint8_t& side : expected) side = side == 0 ? 1 : 0;
  CHECK(sides() == expected);
}

}  // namespace
}  // namespace nacre
