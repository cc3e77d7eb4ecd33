// SPDX-License-Identifier: Apache-2.0
// tests/render/film_test.cc: what a pixel's samples add up to, and what its layers hold beside the
// picture's centre.
#include <algorithm>
#include <cmath>
#include <set>

#include "catch.h"
#include "pictures.h"
#include "render/render.h"
#include "shipped_scenes.h"

namespace nacre {
namespace {

RenderSettings OneThread(std::vector<std::string> layers = {}) {
  return RenderSettings{.threads = 1, .layers = std::move(layers)};
}

MaterialId AddLambert(const Rgb& albedo, Scene* scene) {
  scene->materials.push_back(Material{.model = LambertMaterial{albedo}});
  return {static_cast<uint32_t>(scene->materials.size() - 1)};
}

// A square picture, seen from the origin along -z.
Scene MakeScene(int side, int spp) {
  Scene scene;
  scene.camera.position = {0, 0, 0};
  scene.camera.look_at = {0, 0, -1};
  scene.image.width = side;
  scene.image.height = side;
  scene.image.spp = spp;
  return scene;
}

void AddLight(const std::string& name, decltype(Light::kind) kind, Scene* scene) {
  scene->lights.push_back(Light{.name = name, .kind = std::move(kind)});
}

// An axis-parallel square at depth 5.
Mesh MakeSquare(double left, double right, double half_height, MaterialId material) {
  return {.positions = {{left, -half_height, -5},
                        {right, -half_height, -5},
                        {right, half_height, -5},
                        {left, half_height, -5}},
          .triangles = {0, 1, 2, 0, 2, 3},
          .material = material};
}

TEST_CASE("a filter's negative lobes ring at edges") {
  Scene scene = MakeScene(24, 64);
  scene.image.filter = {FilterKind::kMitchell, 4};
  scene.spheres = {{{0, 0, -5}, 1, AddLambert({1, 1, 1}, &scene)}};
  const Image image = RenderImage(scene, OneThread());
  const std::vector<float>& alpha = image.Find("A")->samples;
  // The filter's step response overshoots by 3.4 %; the pixels' own noise is below 1 %.
  const auto [lowest, highest] = std::minmax_element(alpha.begin(), alpha.end());
  CHECK(*lowest < -0.015f);
  CHECK(*highest > 1.015f);
}

// A layer of depths samples all pixels of a tile that shows anything.
TEST_CASE("pixels that no outline reaches have the bits of sampled ones") {
  for (const PixelFilter filter :
       {PixelFilter{FilterKind::kBox, 1}, PixelFilter{FilterKind::kGaussian, 3},
        PixelFilter{FilterKind::kMitchell, 4}}) {
    Scene scene = MakeScene(50, 7);
    scene.image.filter = filter;
    scene.background = {0.1, 0.7, 1e-3};
    const MaterialId material = AddLambert({1, 1, 1}, &scene);
    scene.spheres = {{{-0.8, 0.7, -5}, 0.4, material}, {{0.6, 0.5, -5}, 0.7, material}};
    RenderSettings settings = OneThread();
    RenderStats few, all;
    const Image image = RenderImage(scene, settings, &few);
    settings.layers = {"Z"};
    const Image sampled = RenderImage(scene, settings, &all);
    CHECK(few.hits == all.hits);
    CHECK(few.camera_rays < all.camera_rays);
    for (const char* channel : {"R", "G", "B", "A"}) {
      CHECK(image.Find(channel)->samples == sampled.Find(channel)->samples);
    }
  }
}

TEST_CASE("all samples of a pixel differ, also where they take several batches") {
  Scene scene = MakeScene(24, 64);
  scene.spheres = {{{0, 0, -5}, 1, AddLambert({1, 1, 1}, &scene)}};
  const FramePlan plan = MakePlan(scene, OneThread());
  REQUIRE(plan.sampling.samples_per_round < 16);
  const Image image = RenderImage(scene, OneThread());
  // A round's samples alone would give no more than 16 shares of coverage beside 0.
  const std::vector<float>& alpha = image.Find("A")->samples;
  CHECK(std::set<float>(alpha.begin(), alpha.end()).size() > 17);
}

TEST_CASE("a pixel's only sample has the bits of its sum") {
  ForEachShippedScene([](const Scene& scene) {
    RenderSettings settings{
        .layers = {"N", "diffuse", "specular", "ambient", "emission", "albedo"}};
    for (const Light& light : scene.lights) {
      if (std::holds_alternative<AmbientLight>(light.kind)) continue;  // a layer of its own
      settings.layers.push_back("light." + light.name);
    }
    settings.region = {5, 3, 90, 51};  // tiles that the picture's edges cut
    RenderSettings general = settings;
    general.general_path = true;
    CHECK_FALSE(MakePlan(scene, general).film.one_sample);
    CHECK(SameBits(RenderImage(scene, settings), RenderImage(scene, general)));
  });
}

TEST_CASE("sums are left out where one sample is all there is") {
  Scene scene = MakeScene(8, 1);
  CHECK(MakePlan(scene, {}).film.one_sample);
  CHECK_FALSE(MakePlan(scene, OneThread({"Z"})).film.one_sample);
  CHECK_FALSE(MakePlan(scene, OneThread({"id.object"})).film.one_sample);
  CHECK_FALSE(MakePlan(scene, {.max_error = 0.1}).film.one_sample);
  scene.image.spp = 2;
  CHECK_FALSE(MakePlan(scene, {}).film.one_sample);
}

TEST_CASE("depth is measured along the view") {
  Scene scene = MakeScene(9, 1);
  scene.meshes = {MakeSquare(-9, 9, 9, AddLambert({1, 1, 1}, &scene))};
  const Image image = RenderImage(scene, OneThread({"Z"}));
  for (const float depth : image.Find("Z")->samples) REQUIRE(depth == Approx(5).epsilon(1e-6));
}

TEST_CASE("positions are those of the sample nearest to the pixel's centre") {
  constexpr int kSide = 9;
  Scene scene = MakeScene(kSide, 64);
  scene.meshes = {MakeSquare(-9, 9, 9, AddLambert({1, 1, 1}, &scene))};
  const Image image = RenderImage(scene, OneThread({"P"}));
  const double pixel = 2 * 5 * std::tan(scene.camera.fov_y_deg * M_PI / 360) / kSide;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const auto at = [&](const char* channel) {
        return image.Find(channel)->samples[static_cast<size_t>(y * kSide + x)] / pixel;
      };
      // One of 64 well-distributed samples is within a quarter of a pixel.
      CHECK(at("P.X") == Approx(x - kSide / 2).margin(0.25));
      CHECK(at("P.Y") == Approx(kSide / 2 - y).margin(0.25));
    }
  }
}

TEST_CASE("meshes have materials and ids of their own, behind those of the spheres") {
  Scene scene = MakeScene(20, 1);
  const MaterialId red = AddLambert({0.5, 0, 0}, &scene);
  const MaterialId green = AddLambert({0, 0.25, 0}, &scene);
  scene.spheres = {{{0, 90, -5}, 1, red}};  // out of sight
  scene.meshes = {MakeSquare(-9, 0, 9, red), MakeSquare(0, 9, 9, green)};
  const Image image = RenderImage(scene, OneThread({"albedo", "id.object", "id.material"}));
  const size_t left = 10 * 20 + 5, right = 10 * 20 + 15;
  const auto at = [&](const char* channel, size_t i) { return image.Find(channel)->samples[i]; };
  CHECK(at("albedo.R", left) == 0.5f);
  CHECK(at("albedo.G", left) == 0);
  CHECK(at("albedo.G", right) == 0.25f);
  CHECK(at("id.object", left) == 2);
  CHECK(at("id.object", right) == 3);
  CHECK(at("id.material", left) == 1);
  CHECK(at("id.material", right) == 2);
}

TEST_CASE("ambient lights add up, and a light of one colour counts") {
  Scene scene = MakeScene(3, 1);
  scene.spheres = {{{0, 0, -5}, 4, AddLambert({0.5, 0.5, 0.5}, &scene)}};
  AddLight("a", AmbientLight{{1, 0, 0}}, &scene);
  AddLight("b", AmbientLight{{2, 0, 1}}, &scene);
  AddLight("sun", DirectionalLight{.direction_of_travel = {0, 0, -1}, .irradiance = {0, M_PI, 0}},
           &scene);
  const Image image = RenderImage(scene, OneThread());
  CHECK(image.Find("R")->samples[4] == Approx(1.5));
  CHECK(image.Find("G")->samples[4] == Approx(0.5));
  CHECK(image.Find("B")->samples[4] == Approx(0.5));
}

TEST_CASE("no shadow ray leaves a side that no light reaches") {
  Scene scene = MakeScene(16, 1);
  scene.spheres = {{{0, 0, -5}, 1, AddLambert({1, 1, 1}, &scene)}};
  AddLight("behind", DirectionalLight{.direction_of_travel = {0, 0, 1}, .irradiance = {1, 1, 1}},
           &scene);
  RenderSettings settings = OneThread();
  settings.general_path = true;
  RenderStats stats;
  RenderImage(scene, settings, &stats);
  CHECK(stats.hits > 0);
  CHECK(stats.shadow_rays == 0);
}

}  // namespace
}  // namespace nacre
