// SPDX-License-Identifier: Apache-2.0
// tests/visibility/shadow_test.cc: occlusion against brute force, and in cases that other tracers
// get wrong.
#include "catch.h"
#include "targets.h"
#include "visibility/rays.h"

namespace nacre {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Shadow rays from the hits of camera rays, to a light or in a direction without one.
std::vector<ShadowRay> ShadowRays(const std::vector<HitSurface>& surfaces, const Vec3d* light,
                                  const Vec3d& to_light) {
  std::vector<ShadowRay> rays;
  for (const HitSurface& surface : surfaces) {
    const Vec3d direction = light != nullptr ? *light - surface.position : to_light;
    rays.push_back(
        {{surface.position, direction}, light != nullptr ? 1 : kInfinity, surface.primitive});
  }
  return rays;
}

void CheckOccluded(const Scene& scene, const std::vector<ShadowRay>& rays, double gap = 0) {
  const TraceGeometry geometry = MakeTraceGeometry(scene, Vec3d(0));
  ForEachTarget([&](Target) {
    const std::vector<bool> occluded = TraceShadows(Intersector(scene, Vec3d(0)), rays);
    CHECK(TraceShadows(Intersector(scene, Vec3d(0), {.shells = true}), rays) == occluded);
    for (size_t i = 0; i < rays.size(); ++i) {
      INFO("ray " << i << " from " << rays[i].primitive);
      REQUIRE(occluded[i] == BruteForceOccluded(geometry, rays[i], gap));
    }
  });
}

TEST_CASE("occlusion is brute force's") {
  Random random(31);
  for (const unsigned count : {1u, 5u, 25u, 300u, 2000u}) {
    const Scene scene = RandomSpheres(&random, count);
    const auto surfaces = TraceSurfaces(Intersector(scene, Vec3d(0)), CameraRays(&random, 1500));
    const Vec3d light = random.InBox({-3, -3, -8}, {3, 3, 2});
    const auto to_light = ShadowRays(surfaces, &light, Vec3d(0));
    const auto along = ShadowRays(surfaces, nullptr, random.Direction() * 7);
    CheckOccluded(scene, to_light);
    CheckOccluded(scene, along);
  }
}

// Large trees trace such rays one by one.
TEST_CASE("occlusion is brute force's in all directions in a large tree") {
  Random random(32);
  const Scene scene = RandomSpheres(&random, 1500);
  const auto surfaces = TraceSurfaces(Intersector(scene, Vec3d(0)), CameraRays(&random, 1500));
  std::vector<ShadowRay> rays;
  for (const HitSurface& surface : surfaces) {
    rays.push_back({{surface.position, random.Direction()}, kInfinity, surface.primitive});
  }
  CheckOccluded(scene, rays);
}

TEST_CASE("a convex body does not shadow itself") {
  Random random(32);
  for (const double radius : {1e-6, 1.0, 1e7}) {
    for (const double distance : {1.5, 10.0, 1e3, 1e6}) {
      Scene scene;
      scene.spheres.push_back(MakeSphere(random.Direction() * distance * radius, radius));
      std::vector<Ray> rays(500);
      for (Ray& ray : rays) {
        ray.direction = scene.spheres[0].center + random.Direction() * radius * 0.99;
      }
      std::vector<ShadowRay> shadows;
      for (const HitSurface& surface : TraceSurfaces(Intersector(scene, Vec3d(0)), rays)) {
        Vec3d direction = random.Direction();
        // The rounding of the position may tilt the tangent plane by as much.
        if (surface.normal.dot(direction) < 4e-16 * distance) direction = -direction;
        shadows.push_back({{surface.position, direction}, kInfinity, 0});
      }
      REQUIRE(shadows.size() > 400);
      for (const bool occluded : TraceShadows(Intersector(scene, Vec3d(0)), shadows)) {
        REQUIRE_FALSE(occluded);
      }
      for (ShadowRay& shadow : shadows) shadow.ray.direction *= -1;
      for (const bool occluded : TraceShadows(Intersector(scene, Vec3d(0)), shadows)) {
        REQUIRE(occluded);
      }
    }
  }
}

TEST_CASE("from inside a sphere its far side is in the way of what lies beyond") {
  Scene scene;
  scene.spheres.push_back(MakeSphere({0, 0, 0}, 2));
  const Vec3d on_surface(0, 0, -2);
  ForEachTarget([&](Target) {
    const Intersector intersector(scene, Vec3d(0));
    const auto occluded = TraceShadows(intersector, {{{on_surface, {0, 0, 1}}, 3.9, 0},
                                                     {{on_surface, {0, 0, 1}}, 4.1, 0},
                                                     {{on_surface, {0, 0, -1}}, kInfinity, 0}});
    CHECK(occluded == std::vector<bool>{false, true, false});
  });
}

TEST_CASE("coincident spheres are one sphere to the rays that leave them") {
  Random random(35);
  const Vec3d center(0.1, -0.2, -5.3);
  Scene scene;
  scene.spheres = {MakeSphere({5, 5, 5}, 1), MakeSphere(center, 1.1), MakeSphere(center, 1.1),
                   MakeSphere(center, 1.1)};
  std::vector<ShadowRay> outward, inward;
  for (uint32_t i = 0; i < 3000; ++i) {
    const Vec3d out = random.Direction();
    const Vec3d along = out + random.Direction() * 0.9;
    outward.push_back({{center + out * 1.1, along}, 1, 1 + i % 3});
    inward.push_back({{center + out * 1.1, -along}, kInfinity, 1 + i % 3});
  }
  ForEachTarget([&](Target) {
    const Intersector intersector(scene, Vec3d(0));
    for (const bool occluded : TraceShadows(intersector, outward)) REQUIRE_FALSE(occluded);
    for (const bool occluded : TraceShadows(intersector, inward)) REQUIRE(occluded);
  });
}

TEST_CASE("nested, touching and almost touching spheres") {
  Random random(33);
  Scene scene;
  scene.spheres = {MakeSphere({0, 0, -5}, 1),        MakeSphere({0, 0, -5}, 1 + 4e-5),
                   MakeSphere({2, 0, -5}, 1),        MakeSphere({0, 2 + 1e-9, -5}, 1),
                   MakeSphere({-0.5, 0, -5}, 0.5),   MakeSphere({0, -1e6 - 1, -5}, 1e6),
                   MakeSphere({0.1, 0.1, -5}, 1e-6), MakeSphere({0, 0, 0}, 100)};
  std::vector<ShadowRay> rays;
  const auto size = static_cast<uint32_t>(scene.spheres.size());
  for (uint32_t i = 0; i < 20000; ++i) {
    const Sphere& sphere = scene.spheres[i % size];
    Vec3d out = random.Direction();
    if (sphere.radius > 1e3) out = (out * 1e-6 + Vec3d(0, 1, 0)).normalized();
    rays.push_back({{sphere.center + out * sphere.radius, random.Direction()},
                    i % 2 == 0 ? kInfinity : random.Magnitude(1e-6, 10),
                    i % size});
  }
  CheckOccluded(scene, rays);
}

TEST_CASE("shadows at the ends of the range of lengths") {
  Random random(36);
  for (const double size : {1e-15, 1e15}) {
    CAPTURE(size);
    Scene scene;
    for (int i = 0; i < 100; ++i) {
      scene.spheres.push_back(MakeSphere(random.InBox(Vec3d(-size), Vec3d(size)),
                                         std::max(1e-15, size * random.Uniform(0, 0.2))));
    }
    std::vector<ShadowRay> rays;
    for (uint32_t i = 0; i < 5000; ++i) {
      const Sphere& sphere = scene.spheres[i % 100];
      const Vec3d origin = sphere.center + random.Direction() * sphere.radius;
      const Vec3d light = random.InBox(Vec3d(-size), Vec3d(size));
      rays.push_back({{origin, light - origin}, i % 2 == 0 ? 1 : kInfinity, i % 100});
    }
    CheckOccluded(scene, rays);
  }
}

// Adds the triangles of a square about a point of a plane, as a reader makes them: somewhere within
// it, turned and moved.
void AddSquare(const Vec3d& within, const Vec3d& normal, double half, Random* random,
               Scene* scene) {
  const Vec3d x = normal.cross(random->Direction()).normalized(), y = normal.cross(x);
  const Vec3d center =
      within + x * random->Uniform(-0.9, 0.9) * half + y * random->Uniform(-0.9, 0.9) * half;
  Mesh mesh{.positions = {center - x * half - y * half, center + x * half - y * half,
                          center + x * half + y * half, center - x * half + y * half},
            .triangles = {0, 1, 2, 0, 2, 3}};
  scene->meshes.push_back(mesh);
}

// A light that lies exactly on a surface is seen from the side that the surface faces, whatever the
// rounding, and a sphere hides it from all that lies behind the sphere.
TEST_CASE("a surface that a light lies on is not in its way") {
  Random random(37);
  for (const double far : {0.0, 1e3, 1e7}) {
    for (int round = 0; round < 30; ++round) {
      CAPTURE(far, round);
      const Vec3d eye = random.Direction() * far;
      const Vec3d light = eye + random.InBox(Vec3d(-3), Vec3d(3)), normal = random.Direction();
      const double radius = random.Magnitude(0.1, 1e3);
      Scene on_sphere, on_square;
      const Sphere lamp_holder = MakeSphere(light + normal * radius, radius);
      on_sphere.spheres = {lamp_holder};
      AddSquare(light, normal, random.Magnitude(0.1, 1e3), &random, &on_square);
      std::vector<ShadowRay> before, behind;
      for (int i = 0; i < 200; ++i) {
        Vec3d out = random.Direction();
        if (out.dot(normal) > 0) out = -out;
        // Not next to the tangent plane, where rounding decides what is hidden.
        out = (out - normal * 0.05).normalized();
        const Vec3d way = out * random.Magnitude(0.1, 100);
        const Vec3d from = light - eye + way;
        before.push_back({{from, light - eye - from}, 1, kNoPrimitive});
        const Vec3d through = light - eye - way * (1 + 40 * radius);
        behind.push_back({{through, light - eye - through}, 1, kNoPrimitive});
      }
      ForEachTarget([&](Target) {
        const auto shadows = [&](const Scene& scene, const std::vector<ShadowRay>& rays) {
          return TraceShadows(Intersector(scene, eye), rays, kAnyLight, false, SumOfAbs(eye));
        };
        for (const bool occluded : shadows(on_sphere, before)) REQUIRE_FALSE(occluded);
        for (const bool occluded : shadows(on_square, before)) REQUIRE_FALSE(occluded);
        for (const bool occluded : shadows(on_sphere, behind)) REQUIRE(occluded);
      });
    }
  }
}

TEST_CASE("a light on the wall of a hollow sphere lights all of it") {
  Random random(38);
  Scene scene;
  scene.spheres = {MakeSphere(Vec3d(0.1, -0.3, 0.2), 2.3)};
  std::vector<ShadowRay> rays;
  const auto on_wall = [&] { return scene.spheres[0].center + random.Direction() * 2.3; };
  for (int i = 0; i < 3000; ++i) {
    const Vec3d from = on_wall();
    rays.push_back({{from, on_wall() - from}, 1, 0});
  }
  ForEachTarget([&](Target) {
    for (const bool occluded : TraceShadows(Intersector(scene, Vec3d(0)), rays)) {
      REQUIRE_FALSE(occluded);
    }
  });
}

// A light near the surface, but not on it, is distinguished from one on it.
TEST_CASE("a light 1e-9 behind a surface is hidden by it") {
  Random random(39);
  Scene scene;
  scene.spheres = {MakeSphere({0, -50, 0}, 0.01), MakeSphere({3, 1, 0}, 1)};
  AddSquare({0, 0, 0}, {0, 1, 0}, 5, &random, &scene);
  std::vector<ShadowRay> to_square, to_sphere;
  for (int i = 0; i < 500; ++i) {
    const Vec3d from(random.Uniform(-1, 1), random.Uniform(-3, -1), random.Uniform(-1, 1));
    to_square.push_back({{from, Vec3d(0, 1e-9, 0) - from}, 1, 0});
    const Vec3d out = random.Direction();
    const Vec3d inside = Vec3d(3, 1, 0) + out * (1 - 1e-9);
    to_sphere.push_back({{inside + out, -out}, 1, 0});
  }
  ForEachTarget([&](Target) {
    const Intersector intersector(scene, Vec3d(0));
    for (const bool occluded : TraceShadows(intersector, to_square)) REQUIRE(occluded);
    for (const bool occluded : TraceShadows(intersector, to_sphere)) REQUIRE(occluded);
  });
}

TEST_CASE("between shells 4e-5 apart the outer one shadows the inner one") {
  Random random(34);
  Scene scene;
  scene.spheres = {MakeSphere({0, 0, -5}, 1), MakeSphere({0, 0, -5}, 1 + 4e-5)};
  std::vector<ShadowRay> beyond, between;
  for (int i = 0; i < 2000; ++i) {
    const Vec3d out = random.Direction();
    const Vec3d position = Vec3d(0, 0, -5) + out;
    beyond.push_back({{position, out}, 4.0001e-5, 0});
    between.push_back({{position, out}, 3.9999e-5, 0});
  }
  ForEachTarget([&](Target) {
    const Intersector intersector(scene, Vec3d(0));
    for (const bool occluded : TraceShadows(intersector, beyond)) REQUIRE(occluded);
    for (const bool occluded : TraceShadows(intersector, between)) REQUIRE_FALSE(occluded);
  });
}

}  // namespace
}  // namespace nacre
