// SPDX-License-Identifier: Apache-2.0
// tests/render/glints_test.cc: where highlights on spheres lie on the film, and how large they are.
#include "render/glints.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "pictures.h"
#include "render/render.h"
#include "visibility/sphere_bins.h"

namespace nacre {
namespace {

constexpr int kWidth = 64;
constexpr double kShininess = 1e3;

// One shiny sphere on black.
Scene Shiny(Projection projection, PhongModel model) {
  PhongMaterial phong{.model = model, .ka = Rgb(0), .kd = Rgb(0), .shininess = kShininess};
  Scene scene = OneSphere(phong, kWidth);
  scene.background = Rgb(0);
  scene.lights.clear();
  scene.camera.projection = projection;
  scene.camera.position = {0, 0, 5};
  scene.camera.look_at = {0, 0, 0};
  scene.camera.fov_y_deg = 25;
  scene.camera.height = 2.2;
  return scene;
}

std::vector<Glint> GlintsOf(const FramePlan& plan, double largest) {
  std::vector<Glint> glints;
  TileCandidate candidate{};
  const Sphere& sphere = plan.scene->spheres[0];
  candidate.sphere = {sphere.center - plan.scene->camera.position, sphere.radius};
  candidate.around_camera = candidate.sphere.center.length() < sphere.radius;
  AddGlints(plan, MakeProjector(plan.camera), candidate, largest, &glints);
  return glints;
}

FramePlan PlanOf(const Scene& scene) { return MakePlan(scene, {.max_error = 0.05}); }

PointLight LampAt(const Vec3d& position) { return {.position = position, .intensity = Rgb(100)}; }

// The brightest pixel of a picture, and the sum of all over it: an area in pixels.
struct Seen {
  double x, y, area;
};

Seen SeenIn(const Scene& scene) {
  Scene sharp = scene;
  sharp.image.spp = 4;
  const Image image = RenderImage(sharp, {}, nullptr);
  const std::vector<float>& red = image.channels[0].samples;
  const auto most = std::max_element(red.begin(), red.end());
  double sum = 0;
  for (const float value : red) sum += value;
  const auto index = static_cast<int>(most - red.begin());
  const int width = scene.image.width;
  return {index % width + 0.5, index / width + 0.5, sum / *most};
}

// Pictures so large that the highlight covers hundreds of pixels show where it is and how large:
// areas grow with the square of the scale. The area is that of the lobe's width at its peak; what
// changes across the lobe, whose width squared is 0.002, and the pixels' size, one of 150, take up
// to 5 % from it. Phong's lobe, around the mirrored direction, is wider across the plane of eye and
// light, by 1 over the cosine of the angle of incidence, which the area leaves out: 5 % more here.
TEST_CASE("highlights lie where pictures show them, and are as large") {
  std::mt19937 random(5);
  const auto number = [&] { return static_cast<double>(random()) / 4294967296.0; };
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    for (const PhongModel model : {PhongModel::kPhong, PhongModel::kBlinnPhong}) {
      for (int i = 0; i < 6; ++i) {
        Scene scene = Shiny(projection, model);
        const Vec3d way(number() - 0.5, number() - 0.5, 1);
        if (i % 2 == 0) {
          scene.lights = {Named("sun", DirectionalLight{-way, Rgb(1)})};
        } else {  // as near as a radius and a half
          scene.lights = {Named("lamp", LampAt(way.normalized() * (2.5 + 2 * number())))};
        }
        const FramePlan plan = PlanOf(scene);
        const std::vector<Glint> glints = GlintsOf(plan, 100);
        REQUIRE(glints.size() == 1);
        constexpr int kScale = 16;
        Scene large = scene;
        large.image.width *= kScale;
        large.image.height *= kScale;
        const Seen seen = SeenIn(large);
        CAPTURE(static_cast<int>(projection), static_cast<int>(model), i, glints[0].x, glints[0].y,
                glints[0].area, seen.x, seen.y, seen.area);
        CHECK(std::abs(glints[0].x * kScale - seen.x) <= 1.5);
        CHECK(std::abs(glints[0].y * kScale - seen.y) <= 1.5);
        CHECK(std::abs(glints[0].area * kScale * kScale / seen.area - 1) <=
              (model == PhongModel::kPhong ? 0.1 : 0.05));
        // Beside it, towards the middle, nothing of it is left.
        const double beside = std::hypot(glints[0].beside_x, glints[0].beside_y);
        const double to_middle = std::hypot(glints[0].x - kWidth / 2.0, glints[0].y - kWidth / 2.0);
        CHECK(beside <= to_middle * (1 + 1e-9));
        CHECK(beside >= std::min(to_middle * (1 - 1e-9), 2 * std::sqrt(glints[0].area / M_PI)));
      }
    }
  }
}

// Facing the light and seen face to face: pi w^2 R^2 of a lobe around the half vector.
TEST_CASE("a highlight seen face to face has the area of its lobe on the sphere") {
  Scene scene = Shiny(Projection::kOrthographic, PhongModel::kBlinnPhong);
  scene.lights = {Named("sun", DirectionalLight{{0, 0, -1}, Rgb(1)})};
  const FramePlan plan = PlanOf(scene);
  const std::vector<Glint> glints = GlintsOf(plan, 100);
  REQUIRE(glints.size() == 1);
  const double scale = kWidth / scene.camera.height;
  CHECK(std::abs(glints[0].x - kWidth / 2.0) <= 1e-9);
  CHECK(std::abs(glints[0].y - kWidth / 2.0) <= 1e-9);
  const double area = M_PI * 2 / (kShininess + 2) * scale * scale;
  CHECK(std::abs(glints[0].area - area) <= 1e-9 * area);
}

TEST_CASE("lamps with an extent show as mirrors show them") {
  Scene scene = Shiny(Projection::kOrthographic, PhongModel::kBlinnPhong);
  MetallicRoughnessMaterial mirror{.metallic = 1, .roughness = 0};
  scene.materials[0].model = mirror;
  SphereAreaLight light{.center = {0, 0, 200}, .radius = 2};
  scene.lights = {Named("lamp", light)};
  const std::vector<Glint> glints = GlintsOf(PlanOf(scene), 100);
  REQUIRE(glints.size() == 1);
  // It is seen under 2 / 199 from the mirror point, and normals turn by half as much; the way to it
  // turns the half vector back by 1 / 398 per radius.
  const double turn = 2.0 / 199 / 2 / (1 + 1.0 / 398), scale = kWidth / scene.camera.height;
  const double area = M_PI * turn * turn * scale * scale;
  CHECK(std::abs(glints[0].area - area) <= 1e-6 * area);
}

TEST_CASE("what shows no small highlight has none") {
  const Scene shiny = [] {
    Scene scene = Shiny(Projection::kPerspective, PhongModel::kBlinnPhong);
    scene.lights = {Named("lamp", LampAt({2, 3, 4}))};
    return scene;
  }();
  REQUIRE(GlintsOf(PlanOf(shiny), 100).size() == 1);
  const double area = GlintsOf(PlanOf(shiny), 100)[0].area;
  CHECK(GlintsOf(PlanOf(shiny), area).empty());

  Scene matte = shiny;
  matte.materials[0].model = LambertMaterial{};
  CHECK(GlintsOf(PlanOf(matte), 100).empty());

  Scene lamp_inside = shiny;
  lamp_inside.lights = {Named("lamp", LampAt({0.1, 0.2, 0.3}))};
  CHECK(GlintsOf(PlanOf(lamp_inside), 100).empty());

  Scene eye_inside = shiny;
  eye_inside.camera.position = {0, 0, 0.5};
  eye_inside.camera.look_at = {0, 0, -1};
  CHECK(GlintsOf(PlanOf(eye_inside), 100).empty());

  Scene lamp_behind = shiny;  // grazing is not reached: the mirror point is hidden from both
  lamp_behind.lights = {Named("sun", DirectionalLight{{0, 0, 1}, Rgb(1)})};
  CHECK(GlintsOf(PlanOf(lamp_behind), 100).empty());
}

}  // namespace
}  // namespace nacre
