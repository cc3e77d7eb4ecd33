// SPDX-License-Identifier: Apache-2.0
// tests/stress/light_test.cc: lights where they should not be: on and in surfaces, at the very
// point that is shaded, and brighter than a float.
#include <cmath>

#include "catch.h"
#include "render/render.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr size_t kCenter = 16 * 33 + 16;

// A sphere whose nearest point to the eye, in the middle of the picture, is (0, 0, -2); two others
// reach above its tangent plane there.
Scene MakeScene(const Vec3d& light_position, double intensity) {
  Scene scene;
  scene.image.width = scene.image.height = 33;
  scene.image.spp = 1;
  scene.camera.position = {0, 0, 0};
  scene.camera.look_at = {0, 0, -1};
  scene.camera.fov_y_deg = 95;
  scene.materials.resize(3);
  scene.materials[0].model = MetallicRoughnessMaterial{.roughness = 0.02};
  scene.materials[1].model = PhongMaterial{.shininess = 1e6};
  scene.materials[2].model = LambertMaterial{};
  scene.spheres = {{{0, 0, -3}, 1, {0}}, {{2, 0, -2.5}, 1, {1}}, {{-2, 0, -2.5}, 1, {2}}};
  Light light;
  light.name = "light";
  light.kind =
      PointLight{.position = light_position, .intensity = Rgb(intensity, intensity, intensity)};
  scene.lights = {light};
  return scene;
}

// The smallest and the largest sample of the beauty; fails on NaN.
struct Extremes {
  float smallest = INFINITY, largest = -INFINITY;
};

Extremes FindExtremes(const Image& image) {
  Extremes extremes;
  size_t nan = 0;
  for (const char* channel : {"R", "G", "B"}) {
    for (const float value : image.Find(channel)->samples) {
      nan += std::isnan(value);
      extremes.smallest = std::min(extremes.smallest, value);
      extremes.largest = std::max(extremes.largest, value);
    }
  }
  CHECK(nan == 0);
  return extremes;
}

TEST_CASE("a light at the shaded point itself lights it not, and the rest finitely") {
  ForEachTarget([](Target) {
    const Image image = RenderImage(MakeScene({0, 0, -2}, 1), {});
    const Extremes extremes = FindExtremes(image);
    CHECK(extremes.smallest >= 0);
    CHECK(std::isfinite(extremes.largest));
    CHECK(image.Find("G")->samples[kCenter] == 0);
    // Whether other surfaces see a light that lies exactly in this one is in doubt.
  });
}

TEST_CASE("a light in a sphere shows nothing outside") {
  ForEachTarget([](Target) {
    for (const Vec3d& position : {Vec3d(0, 0, -3), Vec3d(0.5, 0, -2.5), Vec3d(0, 0, -2 - 1e-12)}) {
      const Extremes extremes = FindExtremes(RenderImage(MakeScene(position, 1e6), {}));
      CHECK(extremes.smallest == 0);
      CHECK(extremes.largest == 0);
    }
  });
}

TEST_CASE("a light of any brightness makes no NaN and nothing negative") {
  ForEachTarget([](Target) {
    for (const double height : {1e-12, 1e-6, 1e-3, 1.0}) {
      for (const FilterKind filter :
           {FilterKind::kBox, FilterKind::kGaussian, FilterKind::kBlackmanHarris}) {
        CAPTURE(height, static_cast<int>(filter));
        Scene scene = MakeScene({0, 0, -2 + height}, 1e30);
        scene.image.spp = 4;
        scene.image.filter.kind = filter;
        const Extremes extremes = FindExtremes(RenderImage(scene, {}));
        CHECK(extremes.smallest >= 0);
        CHECK(extremes.largest > 1e20f);
      }
    }
  });
}

}  // namespace
}  // namespace nacre
