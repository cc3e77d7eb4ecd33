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
  return {.position = Vec3d(0, 0, 4),
          .intensity = Rgb(10),
          .cutoff_deg = cutoff_deg,
          .inner_deg = cutoff_deg,
          .exponent = 0};
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
    PointLight point{.position = Vec3d(0, 0, 4), .intensity = Rgb(10)};
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
  SphereAreaLight around{
      .center = Vec3d(0.3, 0, 0), .radius = 5, .radiance = Rgb(3), .visible = false};
  DiskAreaLight behind{
      .center = Vec3d(0, 0, 3), .facing = Vec3d(0, 0, 1), .radiance = Rgb(3), .visible = false};
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
    Mesh mesh{.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
              .triangles = {0, 1, 2, 0, 2, 3},
              .material = {0}};
    floor.meshes.push_back(mesh);
    CHECK(LargestRed(floor) <= 1e-20f);  // hits are within a rounding of the plane
  });
}

// A floor under a ceiling, which the camera does not see, somewhere in the world.
struct Room {
  Vec3d x, y, z, origin;
  Vec3d operator()(double a, double b, double c) const { return origin + x * a + y * b + z * c; }
};

Room StraightRoom() { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}; }
Room TurnedRoom() {
  const Vec3d y = Vec3d(0.3, 0.9, -0.2).normalized(), x = y.cross(Vec3d(0.1, 0.2, 1)).normalized();
  return {x, y, x.cross(y), {123400.3, -56700.7, 1234500.1}};
}

Mesh Square(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return {.positions = {a, b, c, d}, .triangles = {0, 1, 2, 0, 2, 3}, .material = {0}};
}

Scene FloorUnder(const Room& at, decltype(Light::kind) kind) {
  Scene scene;
  scene.materials.emplace_back().model = LambertMaterial{Rgb(0.8)};
  scene.meshes.push_back(Square(at(-2, -1, -2), at(-2, -1, 2), at(2, -1, 2), at(2, -1, -2)));
  scene.lights.push_back(Named("lamp", std::move(kind)));
  scene.camera.position = at(0, 0.5, 3);
  scene.camera.look_at = at(0, -1, 0);
  scene.camera.up = at.y;
  scene.camera.fov_y_deg = 25;
  scene.image.width = scene.image.height = kSide;
  scene.image.spp = 4;
  return scene;
}

std::vector<decltype(Light::kind)> CeilingLights(const Room& at) {
  RectangleAreaLight rectangle{
      .center = at(0.1, 1, 0.2), .facing = -at.y, .width = 1.1, .height = 0.7, .radiance = Rgb(3)};
  DiskAreaLight disk{
      .center = rectangle.center, .facing = -at.y, .radius = 0.4, .radiance = Rgb(3)};
  MeshAreaLight mesh;
  const Mesh square =
      Square(at(-0.3, 1, -0.3), at(0.4, 1, -0.3), at(0.4, 1, 0.5), at(-0.3, 1, 0.5));
  mesh.mesh = std::make_shared<Mesh>(square);
  mesh.radiance = Rgb(3);
  PointLight point{.position = rectangle.center, .intensity = Rgb(3)};
  SpotLight spot{.position = rectangle.center,
                 .direction_of_travel = -at.y,
                 .intensity = Rgb(3),
                 .cutoff_deg = 60};
  return {rectangle, disk, mesh, point, spot};
}

TEST_CASE("a lamp flush with its ceiling lights as if there were no ceiling") {
  ForEachTarget([](Target) {
    for (const Room& at : {StraightRoom(), TurnedRoom()}) {
      for (const decltype(Light::kind)& kind : CeilingLights(at)) {
        CAPTURE(kind.index());
        const Scene open = FloorUnder(at, kind);
        const Image want = RenderImage(open, {});
        CHECK(LargestRed(open) > 0.01f);
        Scene closed = open;
        // Wide and lopsided, so that no corner's rounding is the lamp's.
        closed.meshes.push_back(Square(at(-7, 1, -6), at(5, 1, -6), at(5, 1, 9), at(-7, 1, 9)));
        CHECK(SameBits(RenderImage(closed, {}), want));
      }
    }
  });
}

// By rounding half of the hits on the ceiling lie below the lamp, which they then face at any
// distance from 0.
TEST_CASE("the back of a ceiling sees nothing of a lamp that is flush with it") {
  ForEachTarget([](Target) {
    for (const Room& at : {StraightRoom(), TurnedRoom()}) {
      for (const size_t form : {0, 1, 2}) {
        for (const bool visible : {true, false}) {
          decltype(Light::kind) kind = CeilingLights(at)[form];
          std::visit(
              [&](auto& light) {
                if constexpr (requires { light.visible; }) light.visible = visible;
              },
              kind);
          Scene scene = FloorUnder(at, kind);
          scene.meshes.push_back(Square(at(-7, 1, -6), at(5, 1, -6), at(5, 1, 9), at(-7, 1, 9)));
          scene.camera.position = at(0.3, 3, 0.2);
          scene.camera.look_at = at(0.1, 1, 0.2);
          scene.camera.up = at.z;
          for (const bool shiny : {false, true}) {
            if (shiny) {
              scene.materials[0].model = MetallicRoughnessMaterial{.roughness = 0.4};
            }
            CAPTURE(form, visible, shiny);
            CHECK(LargestRed(scene) == 0);
          }
        }
      }
    }
  });
}

TEST_CASE("lamps in one plane do not hide one another") {
  const auto with = [](const Room& at, size_t first, size_t second, bool visible) {
    const std::vector<decltype(Light::kind)> kinds = CeilingLights(at);
    Scene scene = FloorUnder(at, kinds[first]);
    scene.lights.push_back(Named("another lamp", kinds[second]));
    for (Light& light : scene.lights) {
      std::visit(
          [&](auto& kind) {
            if constexpr (requires { kind.visible; }) kind.visible = visible;
          },
          light.kind);
    }
    return RenderImage(scene, {});
  };
  ForEachTarget([&](Target) {
    for (const Room& at : {StraightRoom(), TurnedRoom()}) {
      for (const size_t first : {0, 1, 2}) {
        for (const size_t second : {0, 1, 2}) {
          CAPTURE(first, second);
          CHECK(SameBits(with(at, first, second, true), with(at, first, second, false)));
        }
      }
    }
  });
}

TEST_CASE("a light on a sphere over a floor is seen from below, and hidden from above") {
  ForEachTarget([](Target) {
    for (const Room& at : {StraightRoom(), TurnedRoom()}) {
      const Scene open = FloorUnder(at, PointLight{.position = at(0, 1, 0), .intensity = Rgb(3)});
      Scene closed = open;
      closed.spheres.push_back({at(0, 11, 0), 10, {0}});
      CHECK(SameBits(RenderImage(closed, {}), RenderImage(open, {})));
      Scene below = open;
      below.spheres.push_back({at(0, 0.5, 0), 0.5, {0}});
      below.camera.look_at = at(0, -1, 1.5);
      below.camera.fov_y_deg = 8;  // of the floor alone
      CHECK(LargestRed(below) == 0);
    }
  });
}

}  // namespace
}  // namespace nacre
