// SPDX-License-Identifier: Apache-2.0
// tests/render/visible_lights_test.cc: the shapes of lights that the camera sees, and which of them
// it can see at all.
#include <random>

#include "pictures.h"
#include "render/plan.h"
#include "render/render.h"
#include "render/sampled_plan.h"
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
  RectangleAreaLight rectangle;
  rectangle.facing = Vec3d(0, 0, 1);
  rectangle.up = Vec3d(0, 1, 0);
  rectangle.radiance = Rgb(3);
  CHECK(middle(Named("front", rectangle)) == 3);
  rectangle.facing = Vec3d(0, 0, -1);
  CHECK(middle(Named("back", rectangle)) == 0);
  rectangle.two_sided = true;
  CHECK(middle(Named("both", rectangle)) == 3);
  rectangle.visible = false;
  CHECK(middle(Named("hidden", rectangle)) == 0);
  DiskAreaLight disk;
  disk.facing = Vec3d(0, 0, 1);
  disk.radiance = Rgb(3);
  CHECK(middle(Named("disk", disk)) == 3);
  SphereAreaLight sphere;
  sphere.radiance = Rgb(3);
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
  for (int row = 0; row <= kSteps; ++row) {
    double x[kSteps + 1], y[kSteps + 1];
    for (int i = 0; i <= kSteps; ++i) {
      x[i] = -reach + (width + 2 * reach) * i / kSteps;
      y[i] = -reach + (height + 2 * reach) * row / kSteps;
    }
    MakeCameraRays(frame, x, y, kSteps + 1, &rays);
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
      SphereAreaLight light;
      light.center = Vec3d(uniform(-12, 14), uniform(-8, 8), uniform(-6, 14));
      light.radius = uniform(0.05, 1);
      scene.lights = {Named("lamp", light)};
      const bool is_shown = ShowLights(scene) != nullptr;
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

}  // namespace
}  // namespace nacre
