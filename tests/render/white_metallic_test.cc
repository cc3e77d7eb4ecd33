// SPDX-License-Identifier: Apache-2.0
// tests/render/white_metallic_test.cc: a white surface under white light from everywhere, whatever
// its maps make of metallic and roughness: what is no metal and what is one keep all light, and so
// does each mix of them.
#include <cmath>

#include "targets.h"
#include "textured_scenes.h"

namespace nacre {
namespace {

// A unit sphere before an orthographic camera, alone under a sky of radiance 1 that it stands out
// from.
Scene WhiteSphere(const MetallicRoughnessMaterial& model) {
  Scene scene;
  scene.materials.emplace_back().model = model;
  scene.spheres.push_back({Vec3d(0, 0, 0), 1, {0}});
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.position = Vec3d(0, 0, 10);
  scene.camera.height = 2.2;
  scene.image.width = scene.image.height = 64;
  scene.image.spp = 64;
  scene.lights.emplace_back().kind =
      EnvironmentLight{.sky = ConstantSky{Rgb(1)}, .rotate_deg = 0, .background = false};
  scene.lights[0].name = "sky";
  return scene;
}

// The mean of all pixels that lie on the sphere, and how far it may be off by chance.
struct Estimate {
  double mean, deviation;
};

Estimate MeanOf(const Image& image) {
  double sum = 0, squares = 0, count = 0;
  for (size_t i = 0; i < image.data.pixel_count(); ++i) {
    if (image.Find("A")->samples[i] < 1) continue;
    const double x = image.Find("R")->samples[i];
    sum += x;
    squares += x * x;
    count += 1;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0) / count)};
}

// 1e-4: the worst error of albedos at render time (brdf/albedo.h).
void CheckWhite(const Scene& scene) {
  const Estimate estimate = MeanOf(RenderImage(scene, {}));
  CAPTURE(estimate.mean, estimate.deviation);
  CHECK(std::abs(estimate.mean - 1) <= 4 * estimate.deviation + 1e-4);
  CHECK(estimate.deviation < 2e-3);  // the check above could fail
}

TEST_CASE("a white sphere stays white at every metallic, by numbers and by maps") {
  ForEachTarget([](Target) {
    for (const Compensation compensation : {Compensation::kTurquin, Compensation::kKullaConty}) {
      CAPTURE(static_cast<int>(compensation));
      MetallicRoughnessMaterial white;
      white.base_color = Rgb(1);
      white.roughness = 1;
      white.compensation = compensation;
      for (const double metallic : {0.0, 0.5, 1.0}) {
        CAPTURE(metallic);
        white.metallic = metallic;
        CheckWhite(WhiteSphere(white));
      }
      Scene mapped = WhiteSphere(white);
      auto& material = std::get<MetallicRoughnessMaterial>(mapped.materials[0].model);
      material.metallic_roughness_map = AddTexture(
          &mapped, 16, 8, [](int x, int y) { return Rgb(0, 0.3 + 0.1 * y, (x % 8) / 7.0); });
      CheckWhite(mapped);
    }
  });
}

}  // namespace
}  // namespace nacre
