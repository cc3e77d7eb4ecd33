// SPDX-License-Identifier: Apache-2.0
// tests/render/white_level_test.cc: what is brighter than white is a highlight.
#include "render/white_level.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pictures.h"
#include "render/render.h"

namespace nacre {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// One sphere of radius 1 about the origin.
Scene Lit(std::vector<Light> lights) {
  Scene scene = OneSphere(LambertMaterial{Rgb(1)});
  scene.spheres = {{{0, 0, 0}, 1, {0}}};
  scene.background = {0, 0, 0};
  scene.lights = std::move(lights);
  return scene;
}

Light PointAt(const Vec3d& position, double intensity) {
  return Named("point", PointLight{.position = position,
                                   .intensity = {intensity, 0, 0},
                                   .attenuation = Attenuation::InverseSquare()});
}

// Quotients and sums of a few numbers: within some roundings of them.
bool IsNear(double value, double wanted) { return std::abs(value - wanted) <= 1e-14 * wanted; }

TEST_CASE("white is as bright as all lights make it face to face") {
  const Light sun = Named("sun", DirectionalLight{Vec3d(0, -2, 0), Rgb(1, 3, 2)});
  const Light ambient = Named("ambient", AmbientLight{Rgb(0.25, 0.5, 0)});
  CHECK(WhiteLevel(Lit({})) == 0);
  CHECK(IsNear(WhiteLevel(Lit({sun})), 3 / M_PI));
  CHECK(IsNear(WhiteLevel(Lit({sun, ambient})), 3 / M_PI + 0.5));
  // 3 from the sphere outside, 0.5 inside.
  CHECK(IsNear(WhiteLevel(Lit({PointAt({0, 0, 4}, 18)})), 2 / M_PI));
  CHECK(IsNear(WhiteLevel(Lit({PointAt({0, 0.5, 0}, 18)})), 72 / M_PI));
  SpotLight spot{.position = {0, -3, 0}, .intensity = {8, 8, 8}, .attenuation = {1, 0.5, 0.5}};
  CHECK(IsNear(WhiteLevel(Lit({Named("spot", spot)})), 2 / M_PI));
  // On the sphere itself: nothing is brighter.
  CHECK(WhiteLevel(Lit({PointAt({0, 0, 1}, 18)})) == kInfinite);
  CHECK(WhiteLevel(Lit({PointAt({0, 0, 1}, 0)})) == 0);
}

TEST_CASE("white is no darker than what shines by itself, and lessons leave 1/pi out") {
  Scene scene = Lit({Named("sun", DirectionalLight{Vec3d(0, -1, 0), Rgb(3)})});
  PhongMaterial phong;
  scene.materials.emplace_back().model = phong;
  CHECK(IsNear(WhiteLevel(scene), 3 / M_PI));
  phong.convention = PhongConvention::kClassic;
  scene.materials.back().model = phong;
  CHECK(WhiteLevel(scene) == 3);
  scene.background = {0, 4, 0};
  CHECK(WhiteLevel(scene) == 4);
  scene.materials[0].emission = {0, 0, 5};
  CHECK(WhiteLevel(scene) == 5);
}

TEST_CASE("lights with an extent and skies have no white") {
  CHECK(WhiteLevel(Lit({Named("area", SphereAreaLight{})})) == kInfinite);
  CHECK(WhiteLevel(Lit({Named("sky", EnvironmentLight{.sky = ConstantSky{}})})) == kInfinite);
}

TEST_CASE("meshes and very many spheres are near lights, too") {
  Scene scene = Lit({PointAt({0, 5, 0}, M_PI)});
  scene.spheres.clear();
  CHECK(WhiteLevel(scene) == 0);
  Mesh floor{.positions = {{-9, 3, -9}, {9, 3, -9}, {0, 3, 9}}, .triangles = {0, 2, 1}};
  scene.meshes = {floor};
  CHECK(IsNear(WhiteLevel(scene), 0.25));
  scene.meshes.clear();
  // A row of which some stand for all: their distance is at most three more.
  for (int i = 0; i < 10000; ++i) scene.spheres.push_back({{0, 5, i + 10.0}, 1, {0}});
  CHECK(WhiteLevel(scene) <= 1 / 81.0 * (1 + 1e-14));
  CHECK(WhiteLevel(scene) >= 1 / (12.0 * 12));
}

TEST_CASE("no matte surface is brighter than white, and none is much darker that faces its light") {
  Scene scene = Lit(
      {PointAt({1, 2, 4}, 100), PointAt({-3, 1, 3}, 50), Named("ambient", AmbientLight{Rgb(0.1)})});
  for (Light& light : scene.lights) light.shadows = false;
  scene.lights[1].name = "other";
  scene.spheres.push_back({{0, -101, 0}, 100, {0}});
  const std::vector<float> red = RenderImage(scene, {}, nullptr).Find("R")->samples;
  const double brightest = *std::max_element(red.begin(), red.end());
  // The sum over lights that each face the surface: two of them in one place at most.
  CHECK(brightest <= WhiteLevel(scene));
  CHECK(brightest >= WhiteLevel(scene) / 3);
}

}  // namespace
}  // namespace nacre
