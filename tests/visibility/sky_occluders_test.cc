// SPDX-License-Identifier: Apache-2.0
// tests/visibility/sky_occluders_test.cc: shadow rays in all directions by lists, whose float test
// must leave uncertain rays to the double test, against brute force.
#include <cmath>

#include "catch.h"
#include "targets.h"
#include "visibility/rays.h"

namespace nacre {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A ray from a sphere past the silhouette of another one: barely to either side of it, or by far.
Vec3d TowardsRim(const Sphere& sphere, const Vec3d& from, Random* random) {
  const Vec3d to_center = sphere.center - from;
  const double distance2 = to_center.dot(to_center);
  const double radius2 = sphere.radius * sphere.radius;
  const Vec3d side = to_center.cross(random->Direction()).normalized();
  if (distance2 <= radius2) return to_center + side * sphere.radius;
  // The tangent's foot on the sphere, and past it.
  const double sine2 = radius2 / distance2;
  const Vec3d foot = to_center * (1 - sine2) + side * (sphere.radius * std::sqrt(1 - sine2));
  const double past = random->Magnitude(1e-12, 1) * (random->Uniform(0, 1) < 0.5 ? -1 : 1);
  return foot + side * (past * sphere.radius);
}

// Rays from points on every sphere towards every sphere's silhouette, to infinity or to a point
// before the sphere, inside of it or beyond.
std::vector<ShadowRay> RaysToRims(const Scene& scene, const Vec3d& eye, Random* random) {
  std::vector<ShadowRay> rays;
  for (uint32_t i = 0; i < scene.spheres.size(); ++i) {
    for (const Sphere& other : scene.spheres) {
      const Sphere& own = scene.spheres[i];
      const Vec3d world = own.center + random->Direction() * own.radius;
      const Vec3d direction = TowardsRim(other, world, random) * random->Magnitude(1e-3, 1e3);
      const double middle = (other.center - world).dot(direction) / direction.dot(direction);
      const double t_max =
          random->Uniform(0, 1) < 0.5
              ? kInfinity
              : std::abs(middle) * (1 + random->Magnitude(1e-9, 1) * random->Uniform(-1, 1));
      rays.push_back({{world - eye, direction}, t_max, i});
    }
  }
  return rays;
}

void CheckSky(const Scene& scene, const Vec3d& eye, Random* random) {
  const TraceGeometry geometry = MakeTraceGeometry(scene, eye);
  const std::vector<ShadowRay> rays = RaysToRims(scene, eye, random);
  ForEachTarget([&](Target) {
    Intersector intersector(scene, eye, {.threads = 1, .tree = false});
    intersector.FindOccludersOfBall(std::nullopt, {}, false);
    const uint32_t sky = 0;
    const std::vector<bool> found = TraceShadows(intersector, rays, sky, false);
    size_t occluded = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      INFO("ray " << i << " from " << rays[i].primitive);
      REQUIRE(found[i] == BruteForceOccluded(geometry, rays[i]));
      occluded += found[i] ? 1 : 0;
    }
    CHECK(occluded > rays.size() / 20);
    CHECK(occluded < rays.size());
  });
}

TEST_CASE("shadow rays all over are brute force's, to the rims of spheres") {
  Random random(61);
  for (const double size : {1e-19, 1e-17, 1e-6, 1.0, 1e6, 1e19}) {
    CAPTURE(size);
    Scene scene;
    for (int i = 0; i < 60; ++i) {
      scene.spheres.push_back(
          MakeSphere(random.InBox(Vec3d(-size), Vec3d(size)), size * random.Magnitude(1e-4, 0.2)));
    }
    CheckSky(scene, Vec3d(0, 0, 3 * size), &random);
  }
}

TEST_CASE("shadow rays all over between spheres of all sizes far from the eye") {
  Random random(62);
  Scene scene;
  for (int i = 0; i < 50; ++i) {
    const double distance = random.Magnitude(1e-2, 1e4);
    scene.spheres.push_back(
        MakeSphere(random.Direction() * distance, distance * random.Magnitude(1e-5, 0.5)));
    if (i % 10 == 0) scene.spheres.push_back(scene.spheres.back());
  }
  scene.spheres.push_back(MakeSphere({0, -1e6 - 1, 0}, 1e6));
  CheckSky(scene, Vec3d(0), &random);
  CheckSky(scene, random.Direction() * 1e6, &random);
}

}  // namespace
}  // namespace nacre
