// SPDX-License-Identifier: Apache-2.0
// tests/render/measured_test.cc: pictures of spheres of measured materials, against the scalar twin
// and against the model that a table was made of.
#include <cmath>
#include <memory>

#include "catch.h"
#include "measured_tables.h"
#include "pictures.h"
#include "render/frame_plan.h"
#include "render/render.h"

namespace nacre {
namespace {

std::shared_ptr<const MeasuredBrdf> GoldTable() {
  static const auto gold = std::make_shared<const MeasuredBrdf>(AnalyticMerl({.alpha = 0.25}));
  return gold;
}

// What the table was made of.
MetallicRoughnessMaterial GoldModel() {
  MetallicRoughnessMaterial gold;
  gold.base_color = Rgb(1, 0.77, 0.34);
  gold.metallic = 1;
  gold.roughness = 0.5;
  gold.compensation = Compensation::kNone;
  return gold;
}

TEST_CASE("pictures of measured spheres are those of the scalar twin") {
  const auto random = std::make_shared<const MeasuredBrdf>(MakeRglBrdf(RandomRgl(1)));
  for (const auto& brdf : {GoldTable(), random}) {
    for (const Vec3d& toward : {Vec3d(0.3, 0.2, 1), Vec3d(2, 1, 1), Vec3d(-1, 0, -0.5)}) {
      CAPTURE(toward.x, std::holds_alternative<MerlTable>(brdf->table));
      Scene scene = OrthographicSphere(MeasuredMaterial{.brdf = brdf}, 1);
      scene.lights = {
          Named("sun", DirectionalLight{.direction_of_travel = -toward, .irradiance = Rgb(3)})};
      const Image image = RenderImage(scene, {.layers = {"diffuse", "specular"}});
      const Vec3d l = toward.normalized(), v(0, 0, 1);
      size_t lit = 0;
      ForEachSphereNormal(image, 0.05, [&](size_t i, const Vec3d& normal) {
        if ((normal ^ l) < 0.05) return;
        ++lit;
        const Rgb expected =
            EvaluateMeasured(*brdf, MeasuredInterpolation::kLinear, BasisAbout(normal), l, v) * 3;
        for (int c = 0; c < 3; ++c) {
          const char* const names[] = {"R", "G", "B"};
          const float got = image.Find(names[c])->samples[i];
          CHECK(std::abs(got - expected[c]) <= 2e-4 * expected[c] + 1e-5);
          CHECK(image.Find(std::string("specular.") + names[c])->samples[i] == got);
          CHECK(image.Find(std::string("diffuse.") + names[c])->samples[i] == 0);
        }
      });
      CHECK(lit > 300);
    }
  }
}

// Punctual and sampled lights, of which the sky asks for light that grazes the surface, too.
TEST_CASE("a table is as bright as the model that it was made of") {
  const Light lights[] = {
      Named("point", PointLight{.position = Vec3d(3, 4, 5), .intensity = Rgb(100)}),
      Named("disk", DiskAreaLight{.center = Vec3d(2, 2, 4),
                                  .facing = Vec3d(-2, -2, -4),
                                  .radius = 1,
                                  .radiance = Rgb(5)}),
      WhiteSky()};
  for (const Light& light : lights) {
    CAPTURE(light.name);
    const auto picture = [&](decltype(Material::model) model) {
      Scene scene = OneSphere(std::move(model), 64, 64);
      scene.lights = {light};
      return RenderImage(scene, {});
    };
    const Image measured = picture(MeasuredMaterial{.brdf = GoldTable()});
    const Image model = picture(GoldModel());
    const Mean difference = MeanDifference(measured, model);
    const double mean = MeanRed(model).value;
    CAPTURE(difference.value, difference.error, mean);
    CHECK(std::abs(difference.value) <= 4 * difference.error + 0.004 * mean);
    CHECK(difference.error <= 0.004 * mean);
  }
}

TEST_CASE("pictures of measured materials keep to --max-error") {
  Scene scene = OneSphere(MeasuredMaterial{.brdf = GoldTable()}, 48, 512);
  scene.lights = {Named("point", PointLight{.position = Vec3d(3, 4, 5), .intensity = Rgb(100)})};
  const Image truth = RenderImage(scene, {});
  RenderSettings settings;
  settings.max_error = 0.05;
  const Image adaptive = RenderImage(scene, settings);
  const std::vector<float>& got = adaptive.Find("R")->samples;
  const std::vector<float>& wanted = truth.Find("R")->samples;
  size_t within = 0;
  for (size_t i = 0; i < got.size(); ++i) {
    const double bound = 0.05 * std::max(double{wanted[i]}, 0.05);
    within += std::abs(double{got[i]} - wanted[i]) <= bound ? 1 : 0;
  }
  CHECK(static_cast<double>(within) >= 0.95 * static_cast<double>(got.size()));
}

TEST_CASE("measurements that reflect more than they get, or nothing, are noted") {
  const auto notes = [](const std::shared_ptr<const MeasuredBrdf>& brdf) {
    Scene scene = OneSphere(MeasuredMaterial{.brdf = brdf});
    scene.lights = {WhiteSky()};
    return MakePlan(scene, {}).why.notes;
  };
  CHECK(notes(GoldTable()).empty());
  MeasuredBrdf bright = *GoldTable();
  for (float& value : std::get<MerlTable>(bright.table).rgb) value *= 2;
  FinishMeasured(&bright);
  const std::vector<std::string> told = notes(std::make_shared<const MeasuredBrdf>(bright));
  REQUIRE(told.size() == 1);
  CHECK(told[0].find("its measurements reflect up to 1.") != std::string::npos);
  for (float& value : std::get<MerlTable>(bright.table).rgb) value = 0;
  FinishMeasured(&bright);
  const std::vector<std::string> black = notes(std::make_shared<const MeasuredBrdf>(bright));
  REQUIRE(black.size() == 1);
  CHECK(black[0].find("its table has no data") != std::string::npos);
}

TEST_CASE("a measured material without a table is black") {
  Scene scene = OneSphere(MeasuredMaterial{});
  scene.lights = {WhiteSky()};
  CHECK(MeanRed(RenderImage(scene, {})).value == 0);
}

}  // namespace
}  // namespace nacre
