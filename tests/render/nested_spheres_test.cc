// SPDX-License-Identifier: Apache-2.0
// tests/render/nested_spheres_test.cc: spheres within others, that nobody sees and that block no
// more light than those do: with them the picture is found by a tree of shells
// (visibility/shell_tree.h), and has the bits of the picture without them.
#include <cmath>
#include <random>

#include "pictures.h"
#include "render/frame_plan.h"
#include "render/render.h"
#include "targets.h"

namespace nacre {
namespace {

class NestedRandom {
 public:
  explicit NestedRandom(uint32_t seed) : engine_(seed) {}
  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Vec3d InCube(double side) {
    return {Uniform(-side, side), Uniform(-side, side), Uniform(-side, side)};
  }

 private:
  std::mt19937 engine_;
};

// Two large spheres and small ones around them, under all kinds of lights. More than so few that
// light is computed by their normals alone (render/hit_positions.h).
Scene TwoAmongSmall(NestedRandom* random) {
  Scene scene;
  scene.materials.emplace_back().model = LambertMaterial{};
  scene.materials.emplace_back().model = MetallicRoughnessMaterial{};
  scene.materials[1].emission = Rgb(0.5, 0.1, 0);
  scene.camera.position = Vec3d(0, 0, 9);
  scene.camera.fov_y_deg = 30;
  scene.image.width = 48;
  scene.image.height = 32;
  scene.image.spp = 2;
  scene.spheres.push_back({Vec3d(0, 0, 0), 1, {0}});
  scene.spheres.push_back({Vec3d(1.3, 0.2, 0.4), 0.6, {1}});
  for (int i = 0; i < 280; ++i) {
    const Vec3d center = random->InCube(1);
    scene.spheres.push_back({center * Vec3d(3, 2, 1), 0.05, {1}});
  }
  PointLight lamp{.position = Vec3d(4, 5, 6), .intensity = Rgb(90, 80, 70)};
  SphereAreaLight bulb{.center = Vec3d(-4, 3, 4), .radius = 0.4, .radiance = Rgb(9)};
  scene.lights.push_back(Named("lamp", lamp));
  scene.lights.push_back(
      Named("sun", DirectionalLight{.direction_of_travel = {3, -2, -1}, .irradiance = {1, 2, 3}}));
  scene.lights.push_back(Named("bulb", bulb));
  return scene;
}

// Further ones within the two: coincident, concentric and anywhere.
void FillTheTwo(NestedRandom* random, Scene* scene) {
  for (int i = 0; i < 600; ++i) {
    const Sphere around = scene->spheres[static_cast<size_t>(i % 2)];
    const double share = random->Uniform(0, 1);
    Sphere inside = around;
    inside.material = {1};
    if (i % 3 == 1) inside.radius *= 1 - 1e-7 - 0.4 * share;
    if (i % 3 == 2) {
      inside.radius *= 0.999 * share;
      inside.center += Vec3d(0.4, -0.3, 0.5) * ((1 - share) * around.radius);
    }
    scene->spheres.push_back(inside);
  }
}

bool ShellsFind(const Scene& scene, const RenderSettings& settings) {
  return MakePlan(scene, settings).hits.shapes.intersector->SpheresAreNested();
}

void CheckSamePicture(const Scene& plain, const Scene& filled) {
  RenderSettings settings;
  // Not id.object: the lights that are seen have the numbers after those of all spheres.
  settings.layers = {"N", "P", "Z", "id.material"};
  settings.threads = 1;
  REQUIRE_FALSE(ShellsFind(plain, settings));
  REQUIRE(ShellsFind(filled, settings));
  ForEachTarget([&](Target) {
    const Image expected = RenderImage(plain, settings);
    for (const IntersectorChoice choice :
         {IntersectorChoice::kTiles, IntersectorChoice::kEmbree, IntersectorChoice::kAuto}) {
      RenderSettings chosen = settings;
      chosen.intersector = choice;
      REQUIRE(SameBits(RenderImage(filled, chosen), expected));
      chosen.general_path = true;
      REQUIRE(SameBits(RenderImage(filled, chosen), expected));
    }
  });
}

TEST_CASE("spheres inside others and coincident with them change no bit") {
  NestedRandom random(3);
  Scene plain = TwoAmongSmall(&random);
  Scene filled = plain;
  FillTheTwo(&random, &filled);
  SECTION("by perspective") {}
  SECTION("by parallel rays") {
    for (Scene* scene : {&plain, &filled}) {
      scene->camera.projection = Projection::kOrthographic;
      scene->camera.height = 5;
    }
  }
  SECTION("with a lamp in the middle, which nobody sees") {
    for (Scene* scene : {&plain, &filled}) {
      std::get<PointLight>(scene->lights[0].kind).position = Vec3d(0.01, 0.02, 0);
    }
  }
  SECTION("with a light around it all") {
    SphereAreaLight room{.radius = 30, .radiance = Rgb(1)};
    for (Scene* scene : {&plain, &filled}) scene->lights.push_back(Named("room", room));
  }
  SECTION("beside triangles") {
    Mesh mesh{.positions = {{-3, -1, -2}, {3, -1, -2}, {0, 3, 0.5}},
              .triangles = {0, 1, 2},
              .material = {0}};
    for (Scene* scene : {&plain, &filled}) scene->meshes.push_back(mesh);
  }
  CheckSamePicture(plain, filled);
}

TEST_CASE("around the eye and the lamp, shells beyond the nearest change no bit") {
  NestedRandom random(5);
  Scene plain = TwoAmongSmall(&random);
  plain.lights.erase(plain.lights.begin() + 1);  // the sun would be outside
  plain.spheres.push_back({Vec3d(0.5, 0, 0), 12, {0}});
  Scene filled = plain;
  for (int i = 0; i < 500; ++i) {
    Sphere sphere{Vec3d(0.5, 0, 0), 12, {1}};
    if (i % 2 == 0) sphere.radius += random.Uniform(1e-9, 1);
    filled.spheres.push_back(sphere);
  }
  CheckSamePicture(plain, filled);
}

TEST_CASE("between shells only the nearest count") {
  NestedRandom random(7);
  Scene plain = TwoAmongSmall(&random);
  plain.camera.position = Vec3d(0, 0, 1.4);
  plain.camera.fov_y_deg = 100;
  std::get<PointLight>(plain.lights[0].kind).position = Vec3d(0.4, 1.2, 0.5);
  plain.spheres.resize(1);
  plain.spheres.push_back({Vec3d(0, 0.1, 0), 2, {1}});
  Scene filled = plain;
  for (int i = 0; i < 500; ++i) {
    Sphere sphere{Vec3d(0, 0, 0), 0.999 - 0.5 * random.Uniform(0, 1), {1}};
    if (i % 2 == 0) sphere.radius = 2.11 + random.Uniform(0, 1);
    filled.spheres.push_back(sphere);
  }
  plain.lights.resize(1);
  filled.lights.resize(1);
  CheckSamePicture(plain, filled);
}

}  // namespace
}  // namespace nacre
