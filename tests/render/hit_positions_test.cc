// SPDX-License-Identifier: Apache-2.0
// tests/render/hit_positions_test.cc: pictures without the positions of their hits.
#include <algorithm>
#include <cmath>

#include "catch.h"
#include "render/frame_plan.h"
#include "render/pictures.h"
#include "render/render.h"
#include "render/textured_scenes.h"
#include "targets.h"

namespace nacre {
namespace {

// Spheres side by side and one that casts its shadow on another; a lamp far above them.
Scene LitSpheres() {
  Scene scene;
  scene.image.width = 90;
  scene.image.height = 60;
  scene.image.spp = 4;
  scene.materials.emplace_back().model = LambertMaterial{Rgb(0.8, 0.6, 0.4)};
  scene.materials.emplace_back().model = MetallicRoughnessMaterial{};
  for (int i = 0; i < 5; ++i) {
    scene.spheres.push_back({.center = Vec3d(1.5 * i - 3, 0.2 * i, -8),
                             .radius = 0.7,
                             .material = {static_cast<uint32_t>(i % 2)}});
  }
  scene.spheres.push_back({.center = {0.4, 1.2, -7}, .radius = 0.3, .material = {1}});
  Light lamp;
  lamp.name = "lamp";
  lamp.kind = PointLight{.position = {2, 9, -3}, .intensity = {90, 80, 70}};
  Light far;
  far.name = "far";
  far.shadows = false;
  far.kind =
      PointLight{.position = {-6, 5, 3}, .intensity = {50, 60, 70}, .attenuation = {1, 0.1, 0.01}};
  scene.lights = {lamp, far};
  scene.camera.position = Vec3d(0, 0, 0);
  scene.camera.look_at = Vec3d(0, 0, -8);
  return scene;
}

const PlanItem& PositionsOf(const FramePlan& plan) {
  const auto found =
      std::find_if(plan.why.items.begin(), plan.why.items.end(),
                   [](const PlanItem& item) { return item.what == "positions of hits"; });
  REQUIRE(found != plan.why.items.end());
  return *found;
}

TEST_CASE("pictures without positions have the bits of those with them") {
  ForEachTarget([](Target) {
    Scene scene = LitSpheres();
    for (const bool shadows : {true, false}) {
      scene.image.shadows = shadows;
      const FramePlan plan = MakePlan(scene, {});
      CHECK_FALSE(plan.hits.arrays.all_positions);
      CHECK(PositionsOf(plan).used == shadows);
      if (shadows) {
        // Some are asked, not all.
        CHECK(std::count(plan.hits.arrays.may_be_shadowed.begin(),
                         plan.hits.arrays.may_be_shadowed.end(), 1) > 0);
        CHECK(std::count(plan.hits.arrays.may_be_shadowed.begin(),
                         plan.hits.arrays.may_be_shadowed.end(), 0) > 0);
      }
      RenderSettings settings{.threads = 1, .layers = {"light.lamp", "light.far", "N"}};
      const Image got = RenderImage(scene, settings);
      settings.general_path = true;
      CHECK(MakePlan(scene, settings).hits.arrays.all_positions);
      CHECK(SameBits(got, RenderImage(scene, settings)));
      // Embree's batches are never known to be of one sphere.
      settings.intersector = IntersectorChoice::kEmbree;
      CHECK(SameBits(got, RenderImage(scene, settings)));
    }
  });
}

// Holds a picture beside the one with all lights found from positions.
void CheckLastDigits(const Scene& scene) {
  RenderSettings settings{.threads = 1};
  const Image got = RenderImage(scene, settings);
  settings.far_lights = false;
  const Image by_position = RenderImage(scene, settings);
  CHECK_FALSE(SameBits(got, by_position));
  const std::vector<float>& a = got.Find("R")->samples;
  const std::vector<float>& b = by_position.Find("R")->samples;
  // A direction to the light turned by 3 u turns what its cosine and lobe make of it: of at most
  // 1 / alpha = 4 times its angle, where the light grazes in absolute terms.
  const float brightest = *std::max_element(b.begin(), b.end());
  float worst = 0;
  for (size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  CHECK(worst <= 16 * 0x1p-24f * brightest);
}

TEST_CASE("lights found from normals change no more than the last digits") {
  Scene scene = LitSpheres();
  CheckLastDigits(scene);
  // Normals that maps have turned do not say where their hits are.
  scene.materials[0].normal_map.texture = AddConstant(&scene, Rgb(0.8, 0.5, 0.8));
  CheckLastDigits(scene);
}

TEST_CASE("whatever reads positions gets them") {
  const Scene scene = LitSpheres();
  const auto all = [](const Scene& changed, const RenderSettings& settings = {}) {
    return MakePlan(changed, settings).hits.arrays.all_positions;
  };
  CHECK_FALSE(all(scene));
  RenderSettings settings{.layers = {"P"}};
  CHECK(all(scene, settings));
  settings.layers = {"N"};
  CHECK_FALSE(all(scene, settings));
  settings = {};
  settings.intersector = IntersectorChoice::kEmbree;
  CHECK(all(scene, settings));
  Scene changed = scene;
  std::get<PointLight>(changed.lights[0].kind).position =
      changed.spheres[5].center + Vec3d(0, 1, 0);
  CHECK(all(changed));
  changed = scene;
  changed.materials[1].model = MetallicRoughnessMaterial{.roughness = 0.01};
  CHECK(all(changed));
  changed = scene;
  changed.spheres.insert(changed.spheres.end(), 60, scene.spheres[0]);
  CHECK(all(changed));
  changed = scene;
  changed.camera.position = changed.spheres[0].center;
  CHECK(all(changed));
}

}  // namespace
}  // namespace nacre
