// SPDX-License-Identifier: Apache-2.0
// tests/render/fast_lights_test.cc: lights in their fast mode against the same lights sampled: off
// by no more than they tell, and only where they say.
#include "render/fast_lights.h"

#include <cmath>
#include <cstring>

#include "catch.h"
#include "light/harmonics_error.h"
#include "render/fast_pictures.h"
#include "render/render.h"
#include "targets.h"

namespace nacre {
namespace {

// Brighter to one side and upwards, with a broad lamp.
std::shared_ptr<const SkyPicture> LampPicture() {
  auto picture = std::make_shared<SkyPicture>();
  picture->width = 64;
  picture->height = 32;
  picture->rgb.reserve(3 * 64 * 32);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      const bool lamp = std::abs(x - 40) < 5 && std::abs(y - 8) < 4;
      const auto blue = static_cast<float>(1 - 0.02 * y);
      const auto red = static_cast<float>(0.05 + 0.01 * std::abs(x - 32));
      for (const float value : {lamp ? 9.0f : red, lamp ? 7.0f : 0.3f, blue}) {
        picture->rgb.push_back(value);
      }
    }
  }
  return picture;
}

Scene UnderPicture(decltype(Material::model) model) {
  Scene scene = SphereFromAbove(std::move(model), 40);
  Light& light = scene.lights.emplace_back();
  light.name = "sky";
  light.kind = EnvironmentLight{
      .sky = PictureSky{LampPicture(), Rgb(2, 1, 0.5)}, .rotate_deg = 30, .background = false};
  return scene;
}

Vec3d NormalAt(const Image& image, size_t i) {
  return Vec3d(At(image, "N.X", i), At(image, "N.Y", i), At(image, "N.Z", i)).normalized();
}

// The picture is turned by 30 degrees about +y: a normal as it sees it.
Vec3d TurnBack(const Vec3d& n) {
  const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
  return {n.x * c - n.z * s, n.y, n.z * c + n.x * s};
}

constexpr const char* kChannels[] = {"R", "G", "B"};

TEST_CASE("a fast picture of the sky lights matte surfaces as its harmonics, without noise") {
  const Scene scene = UnderPicture(LambertMaterial{Rgb(0.5)});
  const IrradianceHarmonics<double> harmonics = ProjectIrradiance(MapOf(*LampPicture()));
  const RenderSettings settings = Fast({"N"});
  ForEachTarget([&](Target) {
    const Image image = RenderImage(scene, settings);
    size_t seen = 0;
    for (size_t i = 0; i < image.data.pixel_count(); ++i) {
      if (At(image, "A", i) < 1) continue;
      ++seen;
      const Vec3d irradiance = Irradiance(harmonics, TurnBack(NormalAt(image, i)));
      const Vec3d scale = Vec3d(2, 1, 0.5) * (0.5 / M_PI);
      for (int c = 0; c < 3; ++c) {
        const double expected = irradiance[c] * scale[c];
        // Nine terms of up to a few units in float, which may cancel.
        CHECK(std::abs(At(image, kChannels[c], i) - expected) <= 4e-6);
      }
    }
    CHECK(seen > 800);
  });
}

TEST_CASE("a fast picture is off by what the plan tells") {
  const Scene scene = UnderPicture(LambertMaterial{Rgb(0.5)});
  const RenderSettings settings = Fast({"N"});
  const RenderPlan plan = MakePlan(scene, settings);
  REQUIRE(plan.fast_lights.size() == 1);
  const FastLight& told = plan.fast_lights[0];
  CHECK(told.light == "sky");
  CHECK(told.method == "harmonics");
  CHECK(told.points == 256);
  CHECK(told.rms > 0.02);  // it is an approximation
  CHECK(told.worst < 0.3);
  const std::string text = ExplainPlan(plan, nullptr);
  CHECK(text.find("light \"sky\": diffuse reflection from spherical harmonics") !=
        std::string::npos);
  const std::vector<LightCell> cells = MakeLightCells(MapOf(*LampPicture()));
  Vec3d mean(0);
  constexpr int kSteps = 40;  // evenly over the sphere: heights and longitudes
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const double y = 2 * (i / kSteps + 0.5) / kSteps - 1, phi = 2 * M_PI * (i % kSteps) / kSteps;
    const double r = std::sqrt(1 - y * y);
    mean += Irradiance(cells, Vec3d(r * std::sin(phi), y, r * std::cos(phi))) / (kSteps * kSteps);
  }
  const Image image = RenderImage(scene, settings);
  double worst = 0;
  for (size_t i = 0; i < image.data.pixel_count(); ++i) {
    if (At(image, "A", i) < 1) continue;
    const Vec3d exact = Irradiance(cells, TurnBack(NormalAt(image, i)));
    const Vec3d scale = Vec3d(2, 1, 0.5) * (0.5 / M_PI);
    for (int c = 0; c < 3; ++c) {
      const double difference = At(image, kChannels[c], i) / scale[c] - exact[c];
      worst = std::max(worst, std::abs(difference) / mean[c]);
    }
  }
  // The picture's normals lie between the 256, 0.11 radians from the next: harmonics of order 2
  // change little over that.
  CHECK(worst <= 1.1 * told.worst);
  CHECK(worst >= 0.3 * told.worst);
}

TEST_CASE("a white furnace of a fast picture shows nothing") {
  Scene scene = UnderPicture(LambertMaterial{Rgb(1)});
  auto white = std::make_shared<SkyPicture>();
  white->width = 16;
  white->height = 8;
  white->rgb.assign(3 * 16 * 8, 1.0f);
  std::get<EnvironmentLight>(scene.lights[0].kind).sky = PictureSky{white, Rgb(1)};
  const Image image = RenderImage(scene, Fast());
  for (size_t i = 0; i < image.data.pixel_count(); ++i) {
    if (At(image, "A", i) < 1) continue;
    CHECK(std::abs(At(image, "R", i) - 1) <= 2e-6);  // nine terms in float
  }
}

TEST_CASE("fast pictures are sampled where something may cast a shadow") {
  Scene scene = UnderPicture(LambertMaterial{Rgb(0.5)});
  scene.spheres.push_back({Vec3d(0.3, 1.3, 0.5), 0.4, {0}});
  const auto same = [](const Image& a, const Image& b) {
    const auto& x = a.Find("R")->samples;
    return std::memcmp(x.data(), b.Find("R")->samples.data(), 4 * x.size()) == 0;
  };
  // Both spheres can lie in the other's shadow.
  CHECK(same(RenderImage(scene, Fast()), RenderImage(scene, {})));
  // Without shadows there is none to see.
  scene.lights[0].shadows = false;
  CHECK_FALSE(same(RenderImage(scene, Fast()), RenderImage(scene, {})));
  CHECK(MakePlan(scene, {}).fast_lights.empty());
}

}  // namespace
}  // namespace nacre
