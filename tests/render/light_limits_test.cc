// SPDX-License-Identifier: Apache-2.0
// tests/render/light_limits_test.cc: lights at the ends of what they may be: cones as wide as
// half of all directions and as all of them, receivers inside a lamp, and in the plane of one.
#include <algorithm>
#include <cmath>

#include "catch.h"
#include "render/pictures.h"
#include "render/render.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr int kSide = 32;

Scene UnderOne(decltype(Light::kind) kind) {
  Scene scene = OneSphere(LambertMaterial{Rgb(0.8)}, kSide, 1);
  scene.lights.push_back(Named("lamp", std::move(kind)));
  return scene;
}

SpotLight Spot(double cutoff_deg) {
  SpotLight spot;
  spot.position = Vec3d(0, 0, 4);
  spot.intensity = Rgb(10);
  spot.cutoff_deg = spot.inner_deg = cutoff_deg;
  spot.exponent = 0;
  return spot;
}

float LargestRed(const Scene& scene) {
  const Image image = RenderImage(scene, {});
  const std::vector<float>& red = image.Find("R")->samples;
  return *std::max_element(red.begin(), red.end());
}

// Other kernels, a few roundings of values up to 0.3 apart.
void CheckNearly(const Image& a, const Image& b) {
  const std::vector<float>& x = a.Find("R")->samples;
  const std::vector<float>& y = b.Find("R")->samples;
  for (size_t i = 0; i < x.size(); ++i) CHECK(std::abs(x[i] - y[i]) <= 2e-7f);
}

TEST_CASE("a cone of 90 degrees lights half of the world, one of 180 all of it") {
  ForEachTarget([](Target) {
    PointLight point;
    point.position = Vec3d(0, 0, 4);
    point.intensity = Rgb(10);
    const Image all = RenderImage(UnderOne(point), {});
    for (const double cutoff : {90.0, 180.0}) {
      SpotLight towards = Spot(cutoff), away = Spot(cutoff);
      towards.direction_of_travel = Vec3d(0.1, 0.2, -1);
      away.direction_of_travel = -towards.direction_of_travel;
      CheckNearly(RenderImage(UnderOne(towards), {}), all);
      if (cutoff == 180) {
        CheckNearly(RenderImage(UnderOne(away), {}), all);
      } else {
        CHECK(LargestRed(UnderOne(away)) == 0);
      }
    }
    CHECK(LargestRed(UnderOne(point)) > 0.1f);
  });
}

TEST_CASE("what is inside a lamp, behind one or in its plane sees no light") {
  SphereAreaLight around;
  around.center = Vec3d(0.3, 0, 0);
  around.radius = 5;
  around.radiance = Rgb(3);
  around.visible = false;
  DiskAreaLight behind;
  behind.center = Vec3d(0, 0, 3);
  behind.facing = Vec3d(0, 0, 1);
  behind.radiance = Rgb(3);
  behind.visible = false;
  ForEachTarget([&](Target) {
    for (const decltype(Light::kind)& kind :
         {decltype(Light::kind)(around), decltype(Light::kind)(behind)}) {
      Scene scene = UnderOne(kind);
      scene.materials.at(0).model = MetallicRoughnessMaterial{.roughness = 0.4};
      CHECK(LargestRed(scene) == 0);
    }
    // A floor that lies in the plane of a disk.
    DiskAreaLight beside = behind;
    beside.center = Vec3d(3, 0, 0);
    beside.facing = Vec3d(0, 0, 1);
    beside.two_sided = true;
    Scene floor = UnderOne(beside);
    floor.spheres.clear();
    Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.triangles = {0, 1, 2, 0, 2, 3};
    mesh.material = {0};
    floor.meshes.push_back(mesh);
    CHECK(LargestRed(floor) <= 1e-20f);  // hits are within a rounding of the plane
  });
}

}  // namespace
}  // namespace nacre
