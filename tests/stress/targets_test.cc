// SPDX-License-Identifier: Apache-2.0
// tests/stress/targets_test.cc: how far pictures of different SIMD targets may be apart, over all
// models, options, lights and layers.
#include "targets.h"

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "catch.h"
#include "render/render.h"
#include "stress/everything.h"
#include "stress/truth.h"

namespace nacre {
namespace {

// The bound of the design, on 99.99 % of the pixels of each channel; the rest must lie where the
// truth is in doubt: on a limb, a terminator or a shadow's edge.
void CheckAgainst(const Image& reference, const Image& image, const TruthPicture* truth) {
  REQUIRE(image.channels.size() == reference.channels.size());
  for (size_t c = 0; c < image.channels.size(); ++c) {
    const std::vector<float>& expected = reference.channels[c].samples;
    const std::vector<float>& got = image.channels[c].samples;
    size_t apart = 0;
    for (size_t i = 0; i < got.size(); ++i) {
      if (std::abs(got[i] - expected[i]) <= 1e-5f + 1e-4f * std::abs(expected[i])) continue;
      ++apart;
      CAPTURE(image.channels[c].name, i, got[i], expected[i]);
      if (truth != nullptr) CHECK(truth->pixels[i].doubt != kCertain);
    }
    CAPTURE(image.channels[c].name);
    CHECK(apart <= got.size() / 10000);
  }
}

Image Render(const Scene& scene) { return RenderImage(scene, {.layers = {"all"}}); }

void CheckTargets(const Scene& scene, const TruthPicture* truth) {
  const TargetGuard guard;
  PinTarget(SupportedTargets().front());  // scalar, where it is built
  const Image scalar = Render(scene);
  ForEachTarget([&](Target) { CheckAgainst(scalar, Render(scene), truth); });
}

TEST_CASE("targets agree on every model, light and layer") {
  Scene scene = MakeEverything();
  scene.image.width = 480;
  scene.image.height = 270;
  // Where doubt lies is a matter of shapes and lights; not every model has a truth.
  Scene grey = scene;
  for (Material& material : grey.materials) material.model = LambertMaterial{};
  const TruthPicture truth = RenderTruth(grey);
  CheckTargets(scene, &truth);
}

TEST_CASE("targets agree with a mesh, many samples and a filter") {
  Scene scene = MakeEverything();
  AddMesh(&scene);
  scene.image.spp = 7;
  scene.image.filter = {FilterKind::kBlackmanHarris, 3};
  CheckTargets(scene, nullptr);
}

// Bumps so steep that half of the viewers see normals that are bent.
TextureId AddSteepBumps(Scene* scene) {
  constexpr int kWidth = 16, kHeight = 8;
  std::vector<float> texels;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    for (const int factor : {7, 11, 3}) {
      texels.push_back(static_cast<float>(i * factor % 13) / 12);
    }
  }
  scene->images.push_back({"bumps", std::make_shared<const MipChain>(
                                        MakeMipChain(kWidth, kHeight, 3, std::move(texels)))});
  Texture texture{.image = {static_cast<uint32_t>(scene->images.size() - 1)},
                  .mapping = MappingKind::kSpherical};
  scene->textures.push_back(texture);
  return {static_cast<uint32_t>(scene->textures.size() - 1)};
}

TEST_CASE("targets agree on mirrors and lobes of every width under normal and bump maps") {
  Scene scene;
  scene.image.width = 160;
  scene.image.height = 120;
  scene.image.spp = 16;
  scene.camera.position = Vec3d(0, 0, 9);
  const TextureId bumps = AddSteepBumps(&scene);
  for (const double roughness : {0.0, 1e-3, 0.02, 0.4}) {
    for (const double metallic : {0.0, 1.0}) {
      for (const bool normal_map : {true, false}) {
        Material material;
        material.name = "material " + std::to_string(scene.materials.size());
        material.model = MetallicRoughnessMaterial{
            .base_color = Rgb(0.9, 0.8, 0.5), .metallic = metallic, .roughness = roughness};
        if (normal_map) material.normal_map.texture = bumps;
        if (!normal_map) material.bump_map = {bumps, 0.2};
        const auto number = static_cast<uint32_t>(scene.materials.size());
        scene.materials.push_back(material);
        scene.spheres.push_back(
            {Vec3d(number % 4 * 1.5 - 2.25, number / 4 * 1.25 - 1.875, 0), 0.6, {number}});
      }
    }
  }
  scene.lights.push_back({.name = "sky", .kind = EnvironmentLight{.sky = GradientSky{}}});
  scene.lights.push_back(
      {.name = "lamp", .kind = SphereAreaLight{.center = Vec3d(3, 4, 5), .radiance = Rgb(9)}});
  scene.lights.push_back(
      {.name = "key", .kind = PointLight{.position = Vec3d(-4, 1, 4), .intensity = Rgb(20)}});
  CheckTargets(scene, nullptr);
}

}  // namespace
}  // namespace nacre
