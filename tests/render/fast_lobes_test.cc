// SPDX-License-Identifier: Apache-2.0
// tests/render/fast_lobes_test.cc: lobes under pictures of the sky in their fast mode: the split
// sum, to its last digits; off from samples by what the plan tells.
#include <cmath>
#include <memory>

#include "catch.h"
#include "light/prefilter.h"
#include "render/fast_pictures.h"
#include "render/render.h"
#include "shading/material.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr int kWidth = 64, kHeight = 32;

std::shared_ptr<const SkyPicture> Picture(bool uniform) {
  auto picture = std::make_shared<SkyPicture>();
  picture->width = kWidth;
  picture->height = kHeight;
  picture->rgb.reserve(size_t{3} * kWidth * kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool lamp = std::abs(x - 40) < 5 && std::abs(y - 8) < 4;
      for (const float value : {lamp ? 9.0f : 0.3f, 1 - 0.02f * static_cast<float>(y), 0.4f}) {
        picture->rgb.push_back(uniform ? 1.0f : value);
      }
    }
  }
  return picture;
}

Scene UnderPicture(const MetallicRoughnessMaterial& material, bool uniform) {
  Scene scene = SphereFromAbove(material);
  Light& light = scene.lights.emplace_back();
  light.name = "sky";
  light.kind = EnvironmentLight{
      .sky = PictureSky{Picture(uniform), Rgb(1)}, .rotate_deg = 30, .background = false};
  return scene;
}

MetallicRoughnessMaterial Metal(double roughness, Compensation compensation) {
  MetallicRoughnessMaterial metal;
  metal.base_color = Rgb(0.9, 0.6, 0.3);
  metal.metallic = 1;
  metal.roughness = roughness;
  metal.compensation = compensation;
  return metal;
}

RenderSettings FastLobes() { return Fast({"specular", "N"}); }

TEST_CASE("fast lobes are the lobe's albedo times the image that it sees in the mirror") {
  const EnvironmentMap map = MapOf(*Picture(false));
  const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
  for (const Compensation compensation :
       {Compensation::kTurquin, Compensation::kKullaConty, Compensation::kNone}) {
    const Scene scene = UnderPicture(Metal(0.6, compensation), false);
    const PrefilteredMap lobe = Prefilter(map, 0.36);
    const ShadingMaterial material = PrepareMaterial(scene.materials[0], Rgb(0));
    ForEachTarget([&](Target) {
      const Image image = RenderImage(scene, FastLobes());
      size_t seen = 0;
      for (size_t i = 0; i < image.data.pixel_count(); ++i) {
        if (At(image, "A", i) < 1) continue;
        ++seen;
        const Vec3d n = Vec3d(At(image, "N.X", i), At(image, "N.Y", i), At(image, "N.Z", i));
        const Vec3d l = n * (2 * n.z) - Vec3d(0, 0, 1);
        const Vec3d radiance = LookUp(lobe, Vec3d(l.x * c - l.z * s, l.y, l.z * c + l.x * s));
        const auto& model = std::get<MicrofacetModel>(material.model);
        for (int k = 0; k < 3; ++k) {
          const double expected = radiance[k] * LobeAlbedo(model, n.z, k);
          const char* const channels[] = {"specular.R", "specular.G", "specular.B"};
          // Float's albedo (brdf/albedo.h), and a look-up at a normal that is rounded.
          CHECK(std::abs(At(image, channels[k], i) - expected) <= 2e-4 * (expected + 1));
        }
      }
      CHECK(seen > 500);
    });
  }
}

TEST_CASE("a white furnace of a fast picture shows nothing, but where lobes are sampled") {
  for (const double roughness : {0.3, 0.6, 1.0}) {
    MetallicRoughnessMaterial white = Metal(roughness, Compensation::kTurquin);
    white.base_color = Rgb(1);
    const Image image = RenderImage(UnderPicture(white, true), FastLobes());
    for (size_t i = 0; i < image.data.pixel_count(); ++i) {
      if (At(image, "A", i) < 1) continue;
      CHECK(std::abs(At(image, "R", i) - 1) <= 2e-4);  // twice the albedo's error
    }
  }
}

TEST_CASE("fast lobes are off from samples by what the plan tells") {
  Scene scene = UnderPicture(Metal(0.5, Compensation::kTurquin), false);
  const RenderPlan plan = MakePlan(scene, FastLobes());
  REQUIRE(plan.fast_lights.size() == 2);
  const FastLight& told = plan.fast_lights[1];
  CHECK(told.method == "split sum");
  CHECK(told.points == 48);
  CHECK(told.rms > 0.01);  // it is an approximation
  CHECK(told.rms < 0.5);
  const Image fast = RenderImage(scene, FastLobes());
  scene.image.spp = 256;
  RenderSettings sampled;
  sampled.layers = {"specular"};
  const Image truth = RenderImage(scene, sampled);
  double squares = 0, mean = 0, count = 0;
  for (size_t i = 0; i < fast.data.pixel_count(); ++i) {
    if (At(fast, "A", i) < 1 || At(truth, "A", i) < 1) continue;
    squares += std::pow(At(fast, "specular.R", i) - At(truth, "specular.R", i), 2);
    mean += At(truth, "specular.R", i);
    count += 1;
  }
  // Red has the lamp. The picture sees other normals, from one side, and weighs the edge otherwise.
  const double rms = std::sqrt(squares / count) / (mean / count);
  CAPTURE(rms, told.rms, told.worst);
  CHECK(rms <= 2 * told.rms);
  CHECK(rms >= 0.25 * told.rms);
}

TEST_CASE("narrow lobes are sampled") {
  const Scene scene = UnderPicture(Metal(0.2, Compensation::kTurquin), false);
  CHECK(MakePlan(scene, FastLobes()).fast_lights.size() == 1);
}

TEST_CASE("skies by formula have fast lobes, too") {
  Scene scene = UnderPicture(Metal(0.5, Compensation::kTurquin), false);
  auto& light = std::get<EnvironmentLight>(scene.lights[0].kind);
  light.sky = ConstantSky{Rgb(0.5, 1, 2)};
  const RenderPlan constant = MakePlan(scene, FastLobes());
  REQUIRE(constant.fast_lights.size() == 1);
  // Exact, but for the albedo's curves and the noise of what it is held against.
  CHECK(constant.fast_lights[0].worst < 0.01);
  const Image image = RenderImage(scene, FastLobes());
  const ShadingMaterial material = PrepareMaterial(scene.materials[0], Rgb(0));
  for (size_t i = 0; i < image.data.pixel_count(); ++i) {
    if (At(image, "A", i) < 1) continue;
    const auto& model = std::get<MicrofacetModel>(material.model);
    const double expected = LobeAlbedo(model, At(image, "N.Z", i), 1);
    CHECK(std::abs(At(image, "specular.G", i) - expected) <= 2e-4);
    CHECK(std::abs(At(image, "specular.R", i) - LobeAlbedo(model, At(image, "N.Z", i), 0) / 2) <=
          2e-4);
  }

  light.sky = GradientSky{.zenith = Rgb(0.2, 0.5, 1), .horizon = Rgb(1), .ground = Rgb(0.1)};
  const RenderPlan gradient = MakePlan(scene, FastLobes());
  REQUIRE(gradient.fast_lights.size() == 1);
  CHECK(gradient.fast_lights[0].rms > 1e-3);
  CHECK(gradient.fast_lights[0].rms < 0.2);
}

TEST_CASE("a light may be fast by itself, as all of them") {
  Scene scene = UnderPicture(Metal(0.5, Compensation::kTurquin), false);
  scene.image.spp = 1;
  RenderSettings settings = FastLobes();
  const std::vector<float> all = RenderImage(scene, settings).Find("R")->samples;
  settings.fast_lights = false;
  CHECK(MakePlan(scene, settings).fast_lights.empty());
  CHECK(RenderImage(scene, settings).Find("R")->samples != all);
  scene.lights[0].fast = true;
  CHECK(MakePlan(scene, settings).fast_lights.size() == 2);
  CHECK(RenderImage(scene, settings).Find("R")->samples == all);
}

}  // namespace
}  // namespace nacre
