// SPDX-License-Identifier: Apache-2.0
// tests/render/hidden_spheres_test.cc: spheres that others part from the eye are left out of bins
// and trees, and no bit of any picture changes.
#include "visibility/hidden_spheres.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "pictures.h"
#include "render/render.h"
#include "targets.h"

namespace nacre {
namespace {

// So few that none is marked, and more than lists of occluders and offsets by normals take.
constexpr size_t kPlain = 300;

size_t CountHidden(const Scene& scene) {
  const TraceGeometry geometry = MakeTraceGeometry(scene, scene.camera.position, 1);
  return static_cast<size_t>(std::count(geometry.hidden.begin(), geometry.hidden.end(), 1));
}

// Spheres about the middle under a lamp, a sun and a sphere of light that all cast shadows.
Scene Crowd(std::mt19937* random) {
  Scene scene;
  scene.materials.emplace_back().model = LambertMaterial{};
  scene.materials.emplace_back().model = MetallicRoughnessMaterial{};
  scene.lights.push_back(Named(
      "lamp", PointLight{.position = {4, 5, 6}, .intensity = {90, 80, 70}, .attenuation = {}}));
  scene.lights.push_back(
      Named("sun", DirectionalLight{.direction_of_travel = {3, -2, -1}, .irradiance = {1, 2, 3}}));
  SphereAreaLight bulb;
  bulb.center = Vec3d(-4, 3, 4);
  bulb.radius = 0.4;
  bulb.radiance = Rgb(9);
  scene.lights.push_back(Named("bulb", bulb));
  scene.camera.position = Vec3d(0, 0, 9);
  scene.camera.fov_y_deg = 30;
  scene.image.width = 64;
  scene.image.height = 40;
  scene.image.spp = 2;
  std::uniform_real_distribution<double> uniform(-1, 1);
  scene.spheres.push_back({Vec3d(0, 0, 0), 1, {0}});
  scene.spheres.push_back({Vec3d(1.3, 0.2, 0.4), 0.6, {1}});
  while (scene.spheres.size() < kPlain) {
    const Vec3d center(3 * uniform(*random), 2 * uniform(*random), uniform(*random));
    scene.spheres.push_back({center, 0.05, {1}});
  }
  return scene;
}

void CheckSamePicture(const Scene& plain, const Scene& crowded) {
  REQUIRE(CountHidden(plain) == 0);
  ForEachTarget([&](Target) {
    for (const IntersectorChoice choice : {IntersectorChoice::kTiles, IntersectorChoice::kEmbree}) {
      RenderSettings settings;
      settings.layers = {"N", "P", "Z", "id.object"};
      settings.intersector = choice;
      CHECK(SameBits(RenderImage(plain, settings), RenderImage(crowded, settings)));
    }
  });
}

TEST_CASE("spheres inside others and spheres that coincide are left out") {
  std::mt19937 random(3);
  const Scene plain = Crowd(&random);
  Scene crowded = plain;
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 900; ++i) {
    const Sphere& around = plain.spheres[static_cast<size_t>(i % 2)];
    const double size = uniform(random);  // of the shell to the next one inside
    const Vec3d off(0.4 * size, -0.3 * size, 0.5 * size);
    if (i % 3 == 0) {
      crowded.spheres.push_back(around);
    } else if (i % 3 == 1) {
      crowded.spheres.push_back({around.center, around.radius * (1 - 1e-7 - 0.4 * size), {1}});
    } else {
      crowded.spheres.push_back(
          {around.center + off * around.radius, around.radius * (1 - size) * 0.999, {1}});
    }
  }
  CHECK(CountHidden(crowded) >= 890);
  CheckSamePicture(plain, crowded);
  Scene parallel = plain;
  parallel.camera.projection = crowded.camera.projection = Projection::kOrthographic;
  parallel.camera.height = crowded.camera.height = 5;
  CHECK(CountHidden(crowded) >= 890);
  CheckSamePicture(parallel, crowded);
}

TEST_CASE("around the eye the nearest shell is enough") {
  std::mt19937 random(5);
  Scene plain = Crowd(&random);
  plain.lights.erase(plain.lights.begin() + 1);  // the sun would be outside
  plain.spheres.push_back({Vec3d(0.5, 0, 0), 12, {0}});
  Scene crowded = plain;
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 900; ++i) {
    if (i % 2 == 0) {
      crowded.spheres.push_back({Vec3d(0.5, 0, 0), 12.001 + uniform(random), {1}});
    } else {
      crowded.spheres.push_back({Vec3d(20 + uniform(random), uniform(random), 3), 2, {1}});
    }
  }
  CHECK(CountHidden(crowded) >= 890);
  CheckSamePicture(plain, crowded);
}

// What is hidden from the eye may still be in the way of a light that is inside, and is all that is
// seen from there.
TEST_CASE("spheres around a light, or around the eye, hide nothing that is inside") {
  std::mt19937 random(7);
  const Scene plain = Crowd(&random);
  const auto count = [&](const Vec3d& lamp, const Vec3d& eye) {
    Scene crowded = plain;
    std::get<PointLight>(crowded.lights[0].kind).position = lamp;
    crowded.camera.position = eye;
    for (int i = 0; i < 900; ++i) {
      crowded.spheres.push_back({Vec3d(0, 0, 0), 0.5 + 0.4 * i / 900, {1}});
    }
    return CountHidden(crowded);
  };
  CHECK(count({4, 5, 6}, {0, 0, 9}) > 800);
  CHECK(count({0, 0, 0}, {0, 0, 9}) == 0);
  CHECK(count({0, 0, 0.95}, {0, 0, 9}) < 900);  // others than the outermost may hide
  CHECK(count({4, 5, 6}, {0, 0.2, 0.1}) == 0);
}

TEST_CASE("few spheres, and spheres beside one another, are not marked") {
  std::mt19937 random(9);
  Scene scene = Crowd(&random);
  CHECK(CountHidden(scene) == 0);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d center(9 * uniform(random), 9 * uniform(random), 9 * uniform(random));
    scene.spheres.push_back({center, 0.1, {1}});
  }
  CHECK(CountHidden(scene) == 0);
}

}  // namespace
}  // namespace nacre
