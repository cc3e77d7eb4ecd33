// SPDX-License-Identifier: Apache-2.0
// tests/stress/targets_test.cc: how far pictures of different SIMD targets may be apart, over all
// models, options, lights and layers.
#include "targets.h"

#include <cmath>

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

Image Render(const Scene& scene) {
  RenderSettings settings;
  settings.layers = {"all"};
  return RenderImage(scene, settings);
}

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

}  // namespace
}  // namespace nacre
