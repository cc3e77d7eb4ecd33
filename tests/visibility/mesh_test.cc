// SPDX-License-Identifier: Apache-2.0
// tests/visibility/mesh_test.cc: triangles: watertight, the first of equal hits, no self-shadowing.
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "catch.h"
#include "targets.h"
#include "visibility/rays.h"

namespace nacre {
namespace {

// A closed sphere of 20 * 4^level triangles with shared vertices.
Mesh Icosphere(int level, const Vec3d& center, double radius) {
  const double p = (1 + std::sqrt(5.0)) / 2;
  Mesh mesh;
  mesh.positions = {{-1, p, 0},  {1, p, 0},  {-1, -p, 0}, {1, -p, 0}, {0, -1, p},  {0, 1, p},
                    {0, -1, -p}, {0, 1, -p}, {p, 0, -1},  {p, 0, 1},  {-p, 0, -1}, {-p, 0, 1}};
  mesh.triangles = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                    4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                    6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
  for (; level > 0; --level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [at, added] = middles.try_emplace(std::minmax(a, b), mesh.positions.size());
      if (added) mesh.positions.push_back((mesh.positions[a] + mesh.positions[b]) / 2);
      return at->second;
    };
    std::vector<uint32_t> finer;
    for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
      const uint32_t a = mesh.triangles[i], b = mesh.triangles[i + 1], c = mesh.triangles[i + 2];
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const uint32_t v : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca}) finer.push_back(v);
    }
    mesh.triangles = finer;
  }
  for (Vec3d& position : mesh.positions) {
    mesh.normals.push_back(position.normalized());
    position = center + mesh.normals.back() * radius;
  }
  return mesh;
}

Scene SceneOf(std::initializer_list<Mesh> meshes) {
  Scene scene;
  scene.meshes = meshes;
  return scene;
}

// Rays from `origin` that aim exactly at vertices and edges, and next to them.
std::vector<Ray> RaysAtSeams(const Mesh& mesh, const Vec3d& origin, size_t count, Random* random) {
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const size_t i =
        3 * static_cast<size_t>(random->Uniform(0, static_cast<double>(mesh.triangles.size() / 3)));
    const Vec3d& a = mesh.positions[mesh.triangles[i]];
    const Vec3d& b = mesh.positions[mesh.triangles[i + 1]];
    const Vec3d& c = mesh.positions[mesh.triangles[i + 2]];
    const double s = random->Uniform(0, 1);
    const Vec3d nudge = random->Direction() * (b - a).length() * random->Magnitude(1e-17, 1e-6);
    for (const Vec3d& target :
         {a, a + (b - a) * s, b + (c - b) * s, a + nudge, b + (c - b) * 0.5}) {
      rays.push_back({origin, target - origin});
    }
  }
  return rays;
}

TEST_CASE("no ray leaks through a closed mesh") {
  Random random(41);
  for (const double radius : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    const Vec3d center = Vec3d(0.1, -0.2, 0.3) * radius;
    const Mesh mesh = Icosphere(3, center, radius);
    const Vec3d inside = Vec3d(0.4, 0.3, -0.1) * radius;
    const Intersector intersector(SceneOf({mesh}), Vec3d(0));
    const std::vector<Ray> rays = RaysAtSeams(mesh, inside, 200000, &random);
    size_t leaks = 0;
    for (const Hit& hit : Trace(intersector, rays)) leaks += hit.primitive == kNoPrimitive;
    INFO("radius " << radius);
    CHECK(leaks == 0);
  }
}

TEST_CASE("triangle hits are brute force's, on every target") {
  Random random(42);
  Scene scene = SceneOf({Icosphere(2, {0, 0, -4}, 1), Icosphere(1, {0.5, 0.5, -5}, 1.5)});
  scene.spheres = {MakeSphere({1, 0, -4}, 0.5), MakeSphere({-1, -1, -4}, 0.3)};
  std::vector<Ray> rays = CameraRays(&random, 1500);
  for (const Mesh& mesh : scene.meshes) {
    const auto seams = RaysAtSeams(mesh, Vec3d(0), 1000, &random);
    rays.insert(rays.end(), seams.begin(), seams.end());
  }
  const TraceGeometry geometry = MakeTraceGeometry(scene, Vec3d(0));
  ForEachTarget([&](Target) {
    std::vector<Hit> expected;
    for (const Ray& ray : rays) expected.push_back(BruteForce(geometry, ray));
    const Intersector intersector(scene, Vec3d(0));
    CHECK(Trace(intersector, rays) == expected);
    CHECK(Trace(intersector, rays, 1) == expected);
  });
}

TEST_CASE("of triangles at one depth the first is hit") {
  Random random(43);
  Mesh twice = Icosphere(2, {0, 0, -4}, 1);
  const auto once = static_cast<uint32_t>(twice.triangles.size() / 3);
  const std::vector<uint32_t> copy = twice.triangles;
  twice.triangles.insert(twice.triangles.end(), copy.begin(), copy.end());
  ForEachTarget([&](Target) {
    for (const Hit& hit : Trace(Intersector(SceneOf({twice}), Vec3d(0)),
                                RaysAtSeams(twice, Vec3d(0), 2000, &random))) {
      CHECK((hit.primitive < once || hit.primitive == kNoPrimitive));
    }
  });
}

TEST_CASE("refined triangle hits lie on the triangle, with the normal on the ray's side") {
  Random random(44);
  Scene scene = SceneOf({Icosphere(2, {0, 0, -4}, 1), Icosphere(3, {0, 0, 0}, 20)});
  scene.meshes[1].normals.clear();
  scene.spheres.push_back(MakeSphere({2, 2, -9}, 0.5));
  for (int flip = 0; flip < 2; ++flip) {
    const TraceGeometry geometry = MakeTraceGeometry(scene, Vec3d(0));
    const std::vector<Ray> rays = CameraRays(&random, 2000);
    ForEachTarget([&](Target) {
      const std::vector<HitSurface> surfaces = TraceSurfaces(Intersector(scene, Vec3d(0)), rays);
      REQUIRE(surfaces.size() == rays.size());  // the outer mesh is all around
      std::set<uint32_t> objects;
      for (size_t i = 0; i < rays.size(); ++i) {
        const HitSurface& surface = surfaces[i];
        // The sphere, then 320 faces, then the others.
        const uint32_t object = surface.primitive == 0 ? 0 : surface.primitive - 1 < 320 ? 1 : 2;
        objects.insert(object);
        REQUIRE(std::abs(surface.normal.length() - 1) < 1e-15);
        if (object == 0) continue;
        const auto hit = TestTriangle(geometry, surface.primitive - 1, rays[i]);
        REQUIRE(hit.hit);
        // Both are a few roundings from the true point, whose coordinates are below 20.
        REQUIRE((surface.position - rays[i].direction * hit.t).length() < 20 * 64 * 0x1p-53);
        const Vec3d radial = object == 1 ? (surface.position - Vec3d(0, 0, -4)).normalized()
                                         : -surface.position.normalized();
        // Interpolated normals are radial; those of level-3 faces deviate by less than the faces'
        // size.
        REQUIRE((surface.normal - radial).length() < (object == 1 ? 0.02 : 0.1));
      }
      CHECK(objects == std::set<uint32_t>{0, 1, 2});
    });
    // Again with reversed winding: nothing may change.
    for (Mesh& mesh : scene.meshes) {
      for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
        std::swap(mesh.triangles[i], mesh.triangles[i + 1]);
      }
    }
  }
}

TEST_CASE("a mesh shadows others and not the triangle that a ray leaves") {
  Random random(45);
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const Vec3d center = Vec3d(0.3, 0.2, -4) * scale;
    Scene scene = SceneOf({Icosphere(3, center, scale), Icosphere(0, center * 2.0, scale)});
    const TraceGeometry geometry = MakeTraceGeometry(scene, Vec3d(0));
    const Intersector intersector(scene, Vec3d(0));
    std::vector<Ray> rays = CameraRays(&random, 3000);
    const auto seams = RaysAtSeams(scene.meshes[0], Vec3d(0), 1000, &random);
    rays.insert(rays.end(), seams.begin(), seams.end());
    std::vector<ShadowRay> outward, inward;
    for (const HitSurface& surface : TraceSurfaces(intersector, rays)) {
      // Away from the convex mesh and from the other one.
      const auto& corners = geometry.triangles[surface.primitive];
      const Vec3d face = (geometry.positions[corners[1]] - geometry.positions[corners[0]])
                             .cross(geometry.positions[corners[2]] - geometry.positions[corners[0]])
                             .normalized();
      if (surface.primitive >= scene.meshes[0].triangles.size() / 3) continue;
      const Vec3d out = face.dot(surface.position - center) > 0 ? face : -face;
      const Vec3d along = out + random.Direction() * 0.3;
      if (along.z > 0) outward.push_back({{surface.position, along}, 1e9, surface.primitive});
      inward.push_back({{surface.position, -along}, 1e9, surface.primitive});
    }
    REQUIRE(outward.size() > 300);
    ForEachTarget([&](Target) {
      const Intersector traced(scene, Vec3d(0));
      size_t acne = 0, leaks = 0;
      for (const bool occluded : TraceShadows(traced, outward)) acne += occluded;
      for (const bool occluded : TraceShadows(traced, inward)) leaks += !occluded;
      INFO("scale " << scale);
      CHECK(acne == 0);
      CHECK(leaks == 0);
    });
  }
}

TEST_CASE("coplanar neighbours and duplicates do not shadow a floor") {
  Random random(46);
  Scene scene;
  Mesh floor;
  floor.positions = {{-1e6, -1, -1e6}, {1e6, -1, -1e6}, {1e6, -1, 1e6}, {-1e6, -1, 1e6}};
  floor.triangles = {0, 1, 2, 0, 2, 3, 0, 1, 2, 0, 2, 3};
  // Tilted, so that no coordinate of the plane is exact.
  for (Vec3d& p : floor.positions) p += Vec3d(0.1, -0.3, 0.7) * (p.x * 0.37 + p.z * 0.11);
  scene.meshes.push_back(floor);
  const Intersector intersector(scene, Vec3d(0));
  std::vector<ShadowRay> shadows;
  for (const HitSurface& surface : TraceSurfaces(intersector, CameraRays(&random, 3000))) {
    Vec3d direction = random.Direction();
    if (direction.dot(surface.normal) < 0) direction = -direction;
    shadows.push_back({{surface.position, direction}, 1e9, surface.primitive});
  }
  REQUIRE(shadows.size() > 500);
  for (const bool occluded : TraceShadows(intersector, shadows)) CHECK_FALSE(occluded);
}

TEST_CASE("triangles without area and needles do no harm") {
  Mesh mesh;
  mesh.positions = {{0, 0, -5},       {1, 0, -5},   {2, 0, -5},       {0, 0, -5},
                    {-1e3, 1e-3, -4}, {1e3, 0, -4}, {-1e3, -1e-3, -4}};
  mesh.triangles = {0, 1, 2, 0, 0, 1, 0, 3, 1, 4, 6, 5};
  ForEachTarget([&](Target) {
    const Intersector intersector(SceneOf({mesh}), Vec3d(0));
    const auto hits = Trace(intersector, {{Vec3d(0), Vec3d(0, 0, -5)},
                                          {Vec3d(0), Vec3d(0.5, 1, -5)},
                                          {Vec3d(0), Vec3d(-100, 0, -4)}});
    CHECK(hits[0] == Hit{3, 0.8});
    CHECK(hits[1].primitive == kNoPrimitive);
    CHECK(hits[2].primitive == 3);
  });
}

}  // namespace
}  // namespace nacre
