// SPDX-License-Identifier: Apache-2.0
// tests/render/visible_lights_test.cc: the shapes of lights that the camera sees, and which of them
// it can see at all.
#include <random>

#include "pictures.h"
#include "render/camera.h"
#include "render/frame_plan.h"
#include "render/lights_plan.h"
#include "render/render.h"
#include "targets.h"
#include "visibility/sphere_test.h"

namespace nacre {
namespace {

TEST_CASE("a visible light is seen on the side that it shines from") {
  Scene scene;
  scene.camera.position = Vec3d(0, 0, 10);
  scene.image.width = scene.image.height = 16;
  scene.image.spp = 1;
  const auto middle = [&](const Light& light) {
    scene.lights = {light};
    const Image image = RenderImage(scene, {});
    return image.Find("R")->samples[8 * 16 + 8];
  };
  RectangleAreaLight rectangle{.facing = Vec3d(0, 0, 1), .up = Vec3d(0, 1, 0), .radiance = Rgb(3)};
  CHECK(middle(Named("front", rectangle)) == 3);
  rectangle.facing = Vec3d(0, 0, -1);
  CHECK(middle(Named("back", rectangle)) == 0);
  rectangle.two_sided = true;
  CHECK(middle(Named("both", rectangle)) == 3);
  rectangle.visible = false;
  CHECK(middle(Named("hidden", rectangle)) == 0);
  DiskAreaLight disk{.facing = Vec3d(0, 0, 1), .radiance = Rgb(3)};
  CHECK(middle(Named("disk", disk)) == 3);
  SphereAreaLight sphere{.radiance = Rgb(3)};
  CHECK(middle(Named("sphere", sphere)) == 3);
  scene.camera.position = Vec3d(0, 0, 0.5);  // inside
  CHECK(middle(Named("sphere", sphere)) == 0);
}

// Whether one of many rays through the picture, or past its edges by half the filter's width, meets
// the light.
bool IsMet(const Scene& scene, const SphereAreaLight& light) {
  constexpr int kSteps = 60;
  const int width = scene.image.width, height = scene.image.height;
  const double reach = scene.image.filter.width / 2;
  const CameraFrame frame = MakeCameraFrame(scene.camera, width, height);
  RayBatch rays;
  FilmBatch film;
  film.count = kSteps + 1;
  for (int row = 0; row <= kSteps; ++row) {
    for (int i = 0; i <= kSteps; ++i) {
      film.x[static_cast<size_t>(i)] = -reach + (width + 2 * reach) * i / kSteps;
      film.y[static_cast<size_t>(i)] = -reach + (height + 2 * reach) * row / kSteps;
    }
    MakeCameraRays(frame, film, &rays);
    for (size_t i = 0; i < rays.count; ++i) {
      const Vec3d origin(rays.origin.x[i], rays.origin.y[i], rays.origin.z[i]);
      const Vec3d direction(rays.direction.x[i], rays.direction.y[i], rays.direction.z[i]);
      const Vec3d to_center = light.center - scene.camera.position - origin;
      if (TestSphere(to_center, direction, light.radius).hit) return true;
    }
  }
  return false;
}

TEST_CASE("a light in view is shown, and one well out of view is not") {
  std::mt19937 random(71);
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    Scene scene;
    scene.camera.projection = projection;
    scene.camera.position = Vec3d(3, 2, 9);
    scene.camera.look_at = Vec3d(1, 0, 0);
    scene.camera.fov_y_deg = 50;
    scene.camera.height = 6;
    scene.image.width = 64;
    scene.image.height = 24;
    scene.image.filter = {FilterKind::kGaussian, 3};
    int met = 0, shown = 0;
    for (int i = 0; i < 600; ++i) {
      SphereAreaLight light{.center = Vec3d(uniform(-12, 14), uniform(-8, 8), uniform(-6, 14)),
                            .radius = uniform(0.05, 1)};
      scene.lights = {Named("lamp", light)};
      PreparedScene prepared;
      const bool is_shown = AddVisibleLights(scene, &prepared) != nullptr;
      CAPTURE(light.center.x, light.center.y, light.center.z, light.radius);
      const bool is_met = IsMet(scene, light);
      if (is_met) REQUIRE(is_shown);
      met += is_met ? 1 : 0;
      shown += is_shown ? 1 : 0;
    }
    // The planes meet at edges, past which a ball may be near two of them and in sight of none.
    CHECK(met > 50);
    CHECK(shown < met * 1.3);
    CHECK(shown < 400);
  }
}

// Of a lamp that lies exactly in a floor the camera sees all, and of one in its back nothing.
TEST_CASE("a lamp let into a floor is seen whole") {
  for (const double far : {0.0, 1e4}) {
    const Vec3d up = Vec3d(0.3, 0.9, -0.2).normalized(),
                x = up.cross(Vec3d(0.1, 0.2, 1)).normalized();
    const Vec3d z = x.cross(up), at = Vec3d(0.123, -0.456, 0.789) * (1 + far);
    const auto square = [&](double low, double high) {
      return Mesh{.positions = {at + x * low + z * low, at + x * low + z * high,
                                at + x * high + z * high, at + x * high + z * low},
                  .triangles = {0, 1, 2, 0, 2, 3}};
    };
    RectangleAreaLight rectangle{.center = at, .facing = up, .width = 2, .height = 2};
    DiskAreaLight disk{.center = at, .facing = up, .radius = 1};
    MeshAreaLight mesh{.mesh = std::make_shared<Mesh>(square(-1.1, 0.9))};
    for (const decltype(Light::kind)& kind :
         {decltype(Light::kind)(rectangle), decltype(Light::kind)(disk),
          decltype(Light::kind)(mesh)}) {
      CAPTURE(far, kind.index());
      Scene scene;
      scene.materials.emplace_back().model = LambertMaterial{Rgb(0.5)};
      Mesh floor = square(-4, 7);
      floor.material = {0};
      scene.meshes.push_back(floor);
      scene.lights.push_back(Named("lamp", kind));
      scene.camera.position = at + up * 3 + x * 0.1;
      scene.camera.look_at = at;
      scene.camera.up = z;
      scene.camera.fov_y_deg = 14;  // of the lamp alone
      scene.image.width = scene.image.height = 32;
      scene.image.spp = 1;
      ForEachTarget([&](Target) {
        const Image image = RenderImage(scene, {});
        for (const float red : image.Find("R")->samples) REQUIRE(red == 1);
      });
    }
  }
}

}  // namespace
}  // namespace nacre
