// SPDX-License-Identifier: Apache-2.0
// tests/render/rough_diffuse_test.cc: pictures of rough matte spheres, against the scalar twins of
// their models and against what is known of light from everywhere.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "brdf/burley.h"
#include "brdf/eon.h"
#include "catch.h"
#include "pictures.h"
#include "render/frame_plan.h"
#include "render/render.h"

namespace nacre {
namespace {

Scene ClaySphere(decltype(Material::model) model) {
  Scene scene = OrthographicSphere(std::move(model), 1);
  scene.materials[0].name = "clay";
  return scene;
}

// Whether a picture under a distant light is that of brdf(angles), up to floats' rounding: n.l and
// n.v to 2^-24 each, and 0.02 at least.
template <class Brdf>
void CheckPicture(const Scene& scene, const Vec3d& to_light, const Brdf& brdf) {
  const Image image = RenderImage(scene, {.layers = {"N"}});
  size_t lit = 0;
  ForEachSphereNormal(image, 0.02, [&](size_t i, const Vec3d& normal) {
    const Angles<double> a = ComputeAngles(normal, to_light, Vec3d(0, 0, 1));
    if (a.n_dot_l < 0.02) return;
    ++lit;
    const double expected = 3 * a.n_dot_l * brdf(a);
    REQUIRE(std::abs(image.Find("R")->samples[i] - expected) <= 16 * 0x1p-24 / 0.02 * expected);
  });
  CHECK(lit > 500);
}

TEST_CASE("pictures of rough matte spheres are those of the scalar models") {
  for (const Vec3d& to_light : {Vec3d(0, 0, 1), Vec3d(2, 1, 1), Vec3d(-1, 0, -0.5)}) {
    Light sun;
    sun.name = "sun";
    sun.kind = DirectionalLight{.direction_of_travel = -to_light, .irradiance = Rgb(3)};
    const Vec3d l = to_light.normalized();
    for (const double roughness : {0.0, 0.4, 1.0}) {
      CAPTURE(to_light.x, roughness);
      Scene scene = ClaySphere(OrenNayarMaterial{Rgb(0.8), roughness});
      scene.lights = {sun};
      CheckPicture(scene, l, [&](const Angles<double>& a) { return Eon(a, 0.8, roughness); });
      scene = ClaySphere(BurleyMaterial{Rgb(0.8), roughness});
      scene.lights = {sun};
      CheckPicture(scene, l,
                   [&](const Angles<double>& a) { return 0.8 * BurleyDiffuse(a, roughness); });
    }
  }
}

TEST_CASE("a white Oren-Nayar sphere cannot be told from a white sky") {
  for (const double roughness : {0.3, 1.0}) {
    Scene scene = OrthographicSphere(OrenNayarMaterial{Rgb(1), roughness}, 256);
    scene.lights = {WhiteSky()};
    const Mean mean = MeanRed(RenderImage(scene, {}));
    CAPTURE(roughness, mean.value, mean.error);
    CHECK(std::abs(mean.value - 1) <= 4 * mean.error + 1e-6);
    CHECK(mean.error < 1e-3);  // the check above could fail
  }
}

// With a light, so that no note says that there is none.
Scene Lit(Scene scene) {
  scene.lights.push_back(Named("key", DirectionalLight{}));
  return scene;
}

TEST_CASE(
    "a scene that nothing lights says so, and one that shines does not say that it is black") {
  Scene scene = ClaySphere(LambertMaterial{});
  CHECK(MakePlan(Lit(scene), {}).why.notes.empty());
  REQUIRE(MakePlan(scene, {}).why.notes.size() == 1);
  CHECK(MakePlan(scene, {}).why.notes[0].starts_with(
      "the scene has no lights: every shape is black"));
  scene.materials.at(0).emission = Rgb(1);
  CHECK(MakePlan(scene, {}).why.notes.at(0).find("only what its materials emit") !=
        std::string::npos);
}

TEST_CASE("a sky that is black all over lights nothing, and the plan says so") {
  const auto picture = [](float red, float green) {
    auto made = std::make_shared<SkyPicture>();
    made->width = 2;
    made->height = 1;
    made->rgb = {0, 0, 0, red, green, 0};
    return std::shared_ptr<const SkyPicture>(made);
  };
  const auto notes = [](const EnvironmentLight& sky) {
    Scene scene = OneSphere(LambertMaterial{});
    scene.lights.push_back({.name = "sky", .kind = sky});
    return MakePlan(scene, {}).why.notes;
  };
  const Rgb black(0), dim(0, 0, 1e-6);
  const EnvironmentLight dark[] = {{.sky = ConstantSky{black}},
                                   {.sky = GradientSky{black, black, black}},
                                   {.sky = QuadraticSky{.radiance = black}},
                                   {.sky = QuadraticSky{.constant = 0}},
                                   {.sky = PictureSky{picture(0, 0), Rgb(1)}},
                                   {.sky = PictureSky{picture(1, 0), Rgb(0, 1, 1)}}};
  for (const EnvironmentLight& sky : dark) {
    const std::vector<std::string> said = notes(sky);
    CAPTURE(&sky - dark);
    REQUIRE(said.size() == 1);
    CHECK(said[0].starts_with("all lights are black: every shape is black"));
  }
  const EnvironmentLight bright[] = {{.sky = ConstantSky{dim}},
                                     {.sky = GradientSky{dim, black, black}},
                                     {.sky = GradientSky{black, dim, black}},
                                     {.sky = GradientSky{black, black, dim}},
                                     {.sky = QuadraticSky{.constant = 0, .quadratic = 1}},
                                     {.sky = PictureSky{picture(0, 1e-6f), Rgb(1)}}};
  for (const EnvironmentLight& sky : bright) {
    CAPTURE(&sky - bright);
    CHECK(notes(sky).empty());
  }
}

TEST_CASE("a plan notes the light that Burley's term makes, and no other's") {
  const auto notes = [](const decltype(Material::model)& model) {
    const Scene scene = Lit(ClaySphere(model));
    return MakePlan(scene, {}).why.notes;
  };
  CHECK(notes(BurleyMaterial{Rgb(0.5), 1}).empty());
  CHECK(notes(BurleyMaterial{Rgb(1), 0.4}).empty());
  CHECK(notes(OrenNayarMaterial{Rgb(1), 1}).empty());
  const std::vector<std::string> burley = notes(BurleyMaterial{Rgb(0.2, 1, 0.2), 1});
  REQUIRE(burley.size() == 1);
  CHECK(burley[0] ==
        "material \"clay\": burley reflects up to 1.56 times the light that grazes it; oren_nayar "
        "keeps energy");
  MetallicRoughnessMaterial base{
      .base_color = Rgb(1), .diffuse = DiffuseForm::kBurley, .diffuse_roughness = 1};
  CHECK(notes(base).empty());
  base.diffuse_coupling = DiffuseCoupling::kNone;
  CHECK(notes(base).size() == 1);
}

// What it says is mirrored has no highlight, and what it does not has one: the middle pixel's only
// sample looks along the light.
TEST_CASE("a plan notes perfect mirrors, with their roughness") {
  Scene scene = OrthographicSphere(ConductorMaterial{}, 1);
  scene.image.width = scene.image.height = 63;
  scene.image.spp = 1;
  scene.lights = {Named("key", DirectionalLight{Vec3d(0, 0, -1), Rgb(1)})};
  const double least = 0x1p-20;
  for (const double roughness : {0.0, 1e-200, 1e-9, std::nextafter(least, 0), least, 0.5}) {
    std::get<ConductorMaterial>(scene.materials[0].model).roughness = roughness;
    const std::vector<std::string> notes = MakePlan(scene, {}).why.notes;
    CAPTURE(roughness);
    CHECK(notes.size() == (roughness < least ? 1 : 0));
    for (const std::string& note : notes) {
      CHECK(note.find(fmt::format(": roughness {:.6g} is below 2^-20", roughness)) !=
            std::string::npos);
    }
    const Image image = RenderImage(scene, {});
    CHECK((image.Find("R")->samples[63 * 63 / 2] > 0) == (roughness >= least));
  }
  // The greatest of several.
  std::get<ConductorMaterial>(scene.materials[0].model).roughness = 1e-9;
  scene.materials.push_back(scene.materials[0]);
  std::get<ConductorMaterial>(scene.materials[1].model).roughness = 1e-8;
  scene.spheres.push_back({Vec3d(3, 0, 0), 1, MaterialId{1}});
  CHECK(MakePlan(scene, {}).why.notes.at(0).find(
            " and 1 more: the greatest roughness, 1e-08, is") != std::string::npos);
}

TEST_CASE("a plan notes the light that the Phong family makes") {
  const auto notes = [](const PhongMaterial& phong) {
    const Scene scene = Lit(ClaySphere(phong));
    return MakePlan(scene, {}).why.notes;
  };
  PhongMaterial phong = PhongMaterial{.kd = Rgb(0), .ks = Rgb(0.2, 1, 0.2), .shininess = 1};
  REQUIRE(notes(phong).size() == 1);
  CHECK(
      notes(phong)[0] ==
      "material \"clay\": phong reflects up to 1.50 times the light from all around, and of light "
      "that grazes it any multiple; modified_phong with kd + ks of 1 at most keeps energy");
  phong.model = PhongModel::kBlinnPhong;
  REQUIRE(notes(phong).size() == 1);
  CHECK(notes(phong)[0].find("blinn_phong reflects up to 1.89 times") != std::string::npos);
  phong.model = PhongModel::kModifiedPhong;
  CHECK(notes(phong).empty());
  phong.kd = Rgb(0.3);
  REQUIRE(notes(phong).size() == 1);
  CHECK(
      notes(phong)[0] ==
      "material \"clay\": modified_phong reflects up to 1.30 times the light from all around; kd + "
      "ks of 1 at most keeps energy");
  phong.convention = PhongConvention::kClassic;
  CHECK(notes(phong).empty());
  for (const PhongModel model : {PhongModel::kPhong, PhongModel::kBlinnPhong}) {
    CHECK(notes({.model = model, .kd = Rgb(0.5), .ks = Rgb(0.2)}).empty());
    CHECK(notes({.model = model, .kd = Rgb(0.5), .ks = Rgb(0.5)}).size() == 1);
  }
}

}  // namespace
}  // namespace nacre
