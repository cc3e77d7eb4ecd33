// SPDX-License-Identifier: Apache-2.0
// tests/render/layers_over_test.cc: coats and sheen: white surfaces under them stay white, what
// kernels make of them is what the scalar twin says, and maps of theirs are theirs.
#include <algorithm>
#include <cmath>
#include <string>

#include "pictures.h"
#include "scene/coat.h"
#include "scene/idle_layers.h"
#include "shading/scalar_bsdf.h"
#include "targets.h"
#include "textured_scenes.h"

namespace nacre {
namespace {

MetallicRoughnessMaterial WhiteUnderCoat() { return {.base_color = Rgb(1), .coat = 1}; }

// 2e-4: the worst error of two albedos at render time (brdf/albedo.h).
void CheckWhiteUnderCoat(const Scene& scene) {
  const Mean mean = MeanRed(RenderImage(scene, {}));
  CAPTURE(mean.value, mean.error);
  CHECK(std::abs(mean.value - 1) <= 4 * mean.error + 2e-4);
  CHECK(mean.error < 3e-3);  // the check above could fail
}

TEST_CASE("a white surface stays white under a coat of any roughness, by numbers and by maps") {
  ForEachTarget([](Target) {
    for (const double metallic : {0.0, 1.0}) {
      for (const double roughness : {0.0, 0.05, 0.4, 1.0}) {
        for (const double coat : {1.0, 0.3}) {
          CAPTURE(metallic, roughness, coat);
          MetallicRoughnessMaterial white = WhiteUnderCoat();
          white.metallic = metallic;
          white.coat = coat;
          white.coat_roughness = roughness;
          Scene scene = OrthographicSphere(white, 64);
          scene.lights = {WhiteSky()};
          CheckWhiteUnderCoat(scene);
          if (coat < 1) continue;
          auto& mapped = std::get<MetallicRoughnessMaterial>(scene.materials[0].model);
          mapped.coat_map =
              AddTexture(&scene, 16, 8, [](int x, int) { return Rgb((x % 4) / 3.0); });
          mapped.coat_roughness_map =
              AddTexture(&scene, 16, 8, [](int, int y) { return Rgb(0, y / 7.0, 1); });
          CheckWhiteUnderCoat(scene);
        }
      }
    }
  });
}

// A lobe's directions below the surface were light for the level whose normal faced them.
TEST_CASE("a white metal under a coat stays white, whatever normals the two are mapped to") {
  ForEachTarget([](Target) {
    const auto check = [](bool on_base, bool on_coat) {
      CAPTURE(on_base, on_coat);
      MetallicRoughnessMaterial white = WhiteUnderCoat();
      white.metallic = white.roughness = 1;
      white.coat_roughness = 0.5;
      white.coat_ior = 3;
      Scene scene = OrthographicSphere(white, 64);
      scene.lights = {WhiteSky()};
      Material& material = scene.materials[0];
      auto& model = std::get<MetallicRoughnessMaterial>(material.model);
      if (on_base) {
        material.normal_map.texture =
            AddTexture(&scene, 8, 4, [](int, int) { return Rgb(0.8, 0.5, 0.9); });
      }
      if (on_coat) {
        model.coat_normal_map.texture =
            AddTexture(&scene, 8, 4, [](int, int) { return Rgb(0.5, 0.2, 0.9); });
      }
      CheckWhiteUnderCoat(scene);
    };
    check(true, false);
    check(false, true);
    check(true, true);
  });
}

// The worst error of a sphere's pixels against Reflect at the normals that a layer shows, relative
// to it; of pixels away from the outline.
double WorstAgainstTwin(const Scene& scene, const Vec3d& to_light, double irradiance) {
  const ShadingMaterial twin = PrepareMaterial(scene.materials[0]);
  const Image image = RenderImage(scene, {.layers = {"all"}});
  const auto at = [&](const char* name, size_t i) { return double{image.Find(name)->samples[i]}; };
  size_t lit = 0;
  double worst = 0;
  for (size_t i = 0; i < image.channels[0].samples.size(); ++i) {
    if (at("A", i) < 1) continue;
    const Vec3d normal = Vec3d(at("N.X", i), at("N.Y", i), at("N.Z", i)).normalized();
    if (normal.z < 0.1 || (normal ^ to_light) < 0.01) continue;
    const Rgb sum = Reflect(twin, normal, to_light, Vec3d(0, 0, 1)).Sum() * irradiance;
    const Rgb got(at("R", i), at("G", i), at("B", i));
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(got[c] / sum[c] - 1));
    ++lit;
  }
  CHECK(lit > 500);
  return worst;
}

Scene UnderALamp(const MetallicRoughnessMaterial& model, const Vec3d& to_light) {
  Scene scene = OrthographicSphere(model, 1);
  scene.lights = {
      Named("lamp", DirectionalLight{.direction_of_travel = -to_light, .irradiance = Rgb(2)})};
  return scene;
}

TEST_CASE("coats under a lamp reflect what the scalar material does") {
  const Vec3d to_light = Vec3d(0.3, 0.5, 0.8).normalized();
  MetallicRoughnessMaterial model{
      .base_color = Rgb(0.8, 0.3, 0.1), .metallic = 0.3, .roughness = 0.4, .coat_ior = 1.8};
  for (const double coat : {0.5, 1.0}) {
    for (const double roughness : {0.02, 0.09, 0.3, 0.8}) {  // narrow lobes, and wide
      CAPTURE(coat, roughness);
      model.coat = coat;
      model.coat_roughness = roughness;
      ForEachTarget([&](Target) {
        // A float normal, 6e-8, under a lobe of this width; and the albedo's 1e-4 of what is below.
        CHECK(WorstAgainstTwin(UnderALamp(model, to_light), to_light, 2) <=
              2e-4 + 4e-7 / (roughness * roughness));
      });
    }
  }
}

TEST_CASE("sheen under a lamp reflects what the scalar material does, with a coat and without") {
  const Vec3d to_light = Vec3d(0.6, 0.5, 0.3).normalized();
  MetallicRoughnessMaterial model{
      .base_color = Rgb(0.2, 0.3, 0.1), .roughness = 0.6, .sheen_color = Rgb(0.9, 0.5, 0.2)};
  for (const double coat : {0.0, 1.0}) {
    model.coat = coat;
    model.coat_roughness = 0.5;
    for (const double roughness : {0.1, 0.3, 1.0}) {
      CAPTURE(coat, roughness);
      model.sheen_roughness = roughness;
      ForEachTarget([&](Target) {
        // The base's albedo, 1e-4; a float normal, 6e-8, in sin^(1 / alpha).
        CHECK(WorstAgainstTwin(UnderALamp(model, to_light), to_light, 2) <=
              2e-4 + 4e-7 / (roughness * roughness));
      });
    }
  }
}

TEST_CASE("a white surface under white sheen makes no light, and sheen brightens black cloth") {
  ForEachTarget([](Target) {
    for (const double roughness : {0.1, 0.4, 1.0}) {
      CAPTURE(roughness);
      MetallicRoughnessMaterial cloth{
          .base_color = Rgb(1), .sheen_color = Rgb(1), .sheen_roughness = roughness};
      Scene scene = OrthographicSphere(cloth, 64);
      scene.lights = {WhiteSky()};
      const Mean white = MeanRed(RenderImage(scene, {}));
      CHECK(white.value <= 1 + 2e-3 + 4 * white.error);  // brdf/sheen.h: E is right within 1.6e-3
      CHECK(white.value > 0.8);
      auto& black = std::get<MetallicRoughnessMaterial>(scene.materials[0].model);
      // Over a mirror, which is looked along by itself.
      black.metallic = 1;
      black.roughness = 0;
      const Mean mirror = MeanRed(RenderImage(scene, {}));
      CHECK(mirror.value <= 1 + 2e-3 + 4 * mirror.error);
      CHECK(mirror.value > 0.8);
      black.metallic = 0;
      black.base_color = Rgb(0);
      black.specular = 0;
      CHECK(MeanRed(RenderImage(scene, {})).value > 0.05 * roughness);
    }
  });
}

TEST_CASE("a plan notes coats that are perfect mirrors") {
  MetallicRoughnessMaterial model{.coat = 1};
  const auto notes = [&](double roughness, bool lamp) {
    model.coat_roughness = roughness;
    Scene scene = UnderALamp(model, Vec3d(0, 0, 1));
    if (!lamp) scene.lights = {Named("ambient", AmbientLight{Rgb(1)})};
    return MakePlan(scene, {}).why.notes;
  };
  CHECK(notes(0.1, true).empty());
  CHECK(notes(0, false).empty());  // no light has a highlight that could be missed
  REQUIRE(notes(0, true).size() == 1);
  CHECK(notes(0, true)[0].find(": coat_roughness 0 is below 2^-20") != std::string::npos);
}

TEST_CASE("no coat has the bits of none, and constant maps of a coat those of constants") {
  ForEachTarget([](Target) {
    const Rgb share = Held(Rgb(0.6)), width = Held(Rgb(0.1, 0.5, 0.9));
    Material plain;
    MetallicRoughnessMaterial factors{.coat = 0.8, .coat_roughness = 0.6};
    MetallicRoughnessMaterial constant = factors;
    constant.coat = factors.coat * share.x;
    constant.coat_roughness = factors.coat_roughness * width.y;
    plain.model = constant;
    Scene with_maps = TexturedSpheres(Material{.model = factors});
    auto& model = std::get<MetallicRoughnessMaterial>(with_maps.materials[0].model);
    model.coat_map = AddConstant(&with_maps, share);
    model.coat_roughness_map = AddConstant(&with_maps, width);
    CheckSameBits(AllLayers(with_maps), AllLayers(TexturedSpheres(plain)));
  });
}

TEST_CASE("a coat dims what a material emits, by what it reflects") {
  MetallicRoughnessMaterial model{
      .base_color = Rgb(0), .specular = 0, .coat = 1, .coat_roughness = 0.3};
  Scene scene = OrthographicSphere(model, 1);
  scene.materials[0].emission = Rgb(3, 2, 1);
  const ShadingMaterial twin = PrepareMaterial(scene.materials[0]);
  const Image image = RenderImage(scene, {});
  const size_t middle = static_cast<size_t>(32 * 64 + 32);
  const double left = TransmittedByCoat(*twin.coats[0], 1, 1)[0];
  CHECK(left < 0.97);
  // The pixel's centre is half a pixel from the middle: n.v is 1 - 3e-4 there.
  CHECK(std::abs(image.Find("R")->samples[middle] / (3 * left) - 1) < 1e-4);
  CHECK(std::abs(image.Find("B")->samples[middle] / (1 * left) - 1) < 1e-4);
}

TEST_CASE("emission passes OpenPBR's coat as emission_through says") {
  OpenPbrMaterial model{.base_color = Rgb(0), .coat_weight = 1, .coat_color = Rgb(0.25, 0.81, 1)};
  model.fuzz_weight = 1;  // no matter by the text
  model.emission_luminance = 2;
  const size_t middle = static_cast<size_t>(32 * 64 + 32);
  const auto emitted = [&](const char* channel) {
    const Scene scene = OrthographicSphere(model, 1);
    return RenderImage(scene, {}).Find(channel)->samples[middle] / 2;
  };
  // The pixel's centre is half a pixel from the middle: n.v is 1 - 3e-4 there, which makes the path
  // in the coat 1.2e-4 longer.
  CHECK(std::abs(emitted("R") - 0.5) < 1e-4);
  CHECK(std::abs(emitted("G") - 0.9) < 1e-4);
  CHECK(std::abs(emitted("B") - 1) < 1e-6);
  model.options.emission_through = EmissionThrough::kCoatColor;
  CHECK(std::abs(emitted("R") - 0.25) < 1e-6);
  model.options.emission_through = EmissionThrough::kBaseFactors;
  CHECK(emitted("B") < 0.95);  // coat and fuzz reflect
}

TEST_CASE("OpenPBR's emission is the common one in two numbers, below its coat and times the map") {
  OpenPbrMaterial model{.coat_weight = 1, .coat_roughness = 0.3};
  Scene common = TexturedSpheres(Material{.emission = Rgb(3, 1.5, 0.75), .model = model});
  common.materials[0].emission_map = AddConstant(&common, Rgb(Held(0.5)));
  model.emission_luminance = 3;
  model.emission_color = Rgb(1, 0.5, 0.25);
  Scene scene = TexturedSpheres(Material{.model = model});
  scene.materials[0].emission_map = AddConstant(&scene, Rgb(Held(0.5)));
  CHECK_FALSE(RemoveIdleLayers(scene, &scene.materials[0]));  // though `emission` is 0
  CheckSameBits(AllLayers(scene), AllLayers(common));
  const Image image = AllLayers(scene);
  const auto& emitted = image.Find("emission.R")->samples;
  CHECK(*std::max_element(emitted.begin(), emitted.end()) > 1);
}

TEST_CASE("coats and sheen reflect of ambient light what they reflect of a white sky") {
  MetallicRoughnessMaterial bare;
  bare.specular = 0;  // under ambient light a dielectric reflects by its colour alone
  std::vector<MetallicRoughnessMaterial> covered(3, bare);
  covered[0].coat = covered[2].coat = 1;
  covered[0].coat_roughness = covered[2].coat_roughness = 0.4;
  covered[1].sheen_color = covered[2].sheen_color = Rgb(1);
  covered[1].sheen_roughness = covered[2].sheen_roughness = 0.6;
  for (MetallicRoughnessMaterial model : covered) {
    CAPTURE(model.coat, model.sheen_color.x);
    for (const double base : {0.0, 1.0}) {
      model.base_color = Rgb(base);
      Scene scene = OrthographicSphere(model, 64);
      scene.lights = {WhiteSky()};
      const Mean of_sky = MeanRed(RenderImage(scene, {}));
      scene.lights = {Named("ambient", AmbientLight{.radiance = Rgb(1)})};
      const Image image = RenderImage(scene, {});
      const Mean mean = MeanRed(image);
      CAPTURE(base, of_sky.value, of_sky.error, mean.value);
      // 1.6e-3: the error of Charlie's albedo (brdf/sheen.h). 2e-4: of two albedos (brdf/albedo.h).
      const double fits = 1.6e-3 + 2e-4;
      if (base == 0) {
        CHECK(mean.value > 0.03);
        CHECK(std::abs(of_sky.value - mean.value) <= 4 * of_sky.error + fits);
      } else {
        CHECK(std::abs(mean.value - 1) <= 1e-6);
      }
      // Maps of 1 change nothing.
      auto& mapped = std::get<MetallicRoughnessMaterial>(scene.materials[0].model);
      mapped.coat_map = mapped.sheen_color_map = AddConstant(&scene, Rgb(1));
      CHECK(SameBits(image.Find("R")->samples, RenderImage(scene, {}).Find("R")->samples));
    }
  }
}

TEST_CASE("the normal map of the base is not the coat's, nor the coat's the base's") {
  MetallicRoughnessMaterial model{.base_color = Rgb(0)};
  model.specular = 0;  // the coat alone is seen
  model.coat = 1;
  model.coat_roughness = 0.3;
  Scene plain = OrthographicSphere(model, 1);
  plain.lights = {Named("lamp", DirectionalLight{.direction_of_travel = Vec3d(-0.3, -0.2, -1),
                                                 .irradiance = Rgb(1)})};
  Scene turned = plain;
  const TextureId leaning = AddTexture(&turned, 8, 4, [](int, int) { return Rgb(0.8, 0.5, 0.9); });
  turned.materials[0].normal_map.texture = leaning;
  const Image expected = RenderImage(plain, {});
  CHECK(SameBits(expected.Find("R")->samples, RenderImage(turned, {}).Find("R")->samples));
  turned.materials[0].normal_map = {};
  std::get<MetallicRoughnessMaterial>(turned.materials[0].model).coat_normal_map.texture = leaning;
  CHECK_FALSE(SameBits(expected.Find("R")->samples, RenderImage(turned, {}).Find("R")->samples));
}

}  // namespace
}  // namespace nacre
