// SPDX-License-Identifier: Apache-2.0
// tests/render/white_metallic_test.cc: a white surface under white light from everywhere, whatever
// its maps make of metallic and roughness: what is no metal and what is one keep all light, and so
// does each mix of them.
#include <cmath>

#include "pictures.h"
#include "targets.h"
#include "textured_scenes.h"

namespace nacre {
namespace {

Scene WhiteSphere(const MetallicRoughnessMaterial& model) {
  Scene scene = OrthographicSphere(model, 64);
  scene.lights = {WhiteSky()};
  return scene;
}

// 1e-4: the worst error of albedos at render time (brdf/albedo.h).
void CheckWhite(const Scene& scene) {
  const Mean mean = MeanRed(RenderImage(scene, {}));
  CAPTURE(mean.value, mean.error);
  CHECK(std::abs(mean.value - 1) <= 4 * mean.error + 1e-4);
  CHECK(mean.error < 2e-3);  // the check above could fail
}

TEST_CASE("a white sphere stays white at every metallic, by numbers and by maps") {
  ForEachTarget([](Target) {
    for (const Compensation compensation : {Compensation::kTurquin, Compensation::kKullaConty}) {
      CAPTURE(static_cast<int>(compensation));
      MetallicRoughnessMaterial white{
          .base_color = Rgb(1), .roughness = 1, .compensation = compensation};
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
