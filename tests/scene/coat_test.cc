// SPDX-License-Identifier: Apache-2.0
// tests/scene/coat_test.cc: a clear coat as a surface of its own: what it takes from the material
// below, and what its index of refraction makes of it.
#include "scene/coat.h"

#include "brdf/fresnel.h"
#include "catch.h"

namespace nacre {
namespace {

MetallicRoughnessMaterial CoatModel(const MetallicRoughnessMaterial& below) {
  return std::get<MetallicRoughnessMaterial>(
      CoatsOf(Material{.model = below}).at(0).material.model);
}

TEST_CASE("a coat has the roughness, shadowing and maps that its material gives it") {
  MetallicRoughnessMaterial below{.metallic = 1,
                                  .specular = 0.3,
                                  .roughness = 0.9,
                                  .compensation = Compensation::kKullaConty,
                                  .base_color_map = TextureId{3},
                                  .coat = 0.7,
                                  .coat_roughness = 0.25,
                                  .coat_map = TextureId{1},
                                  .coat_roughness_map = TextureId{2}};
  for (const Shadowing shadowing : {Shadowing::kHeightCorrelated, Shadowing::kSeparable,
                                    Shadowing::kSchlickDirect, Shadowing::kSchlickIbl}) {
    below.shadowing = shadowing;
    const MetallicRoughnessMaterial coat = CoatModel(below);
    CHECK(coat.shadowing == shadowing);
    CHECK(coat.roughness == 0.25);
    CHECK(coat.specular == 0.7);
    CHECK(coat.metallic == 0);
    CHECK(coat.base_color == Rgb(0));
    CHECK(coat.dielectric_f0 == Rgb(FresnelF0(1.5, 0.0)));
    CHECK(coat.compensation == Compensation::kNone);
    CHECK(coat.specular_map == TextureId{1});
    CHECK(coat.metallic_roughness_map == TextureId{2});
    CHECK_FALSE(coat.base_color_map.valid());
  }
}

TEST_CASE("a coat of the index of air is none, and one next to it hardly shines at any angle") {
  MetallicRoughnessMaterial below{.coat = 1, .coat_ior = 1};
  CHECK(CoatsOf(Material{.model = below}).empty());
  double before = 0;
  for (const double ior : {1.0001, 1.01, 1.1, 1.2, 1.3}) {
    CAPTURE(ior);
    below.coat_ior = ior;
    const MetallicRoughnessMaterial coat = CoatModel(below);
    const double f0 = coat.dielectric_f0.x * coat.specular;
    // Rounding of a quotient and its product.
    CHECK(f0 == Approx(FresnelF0(ior, 0.0)).epsilon(1e-14));
    CHECK(AverageSchlick(f0, coat.specular) == Approx(AverageDielectric(ior)).epsilon(1e-12));
    CHECK(coat.specular > before);
    before = coat.specular;
  }
  for (const double ior : {1.4, 1.5, 2.0, 10.0}) {
    CAPTURE(ior);
    below.coat_ior = ior;
    CHECK(CoatModel(below).specular == 1);  // Schlick's curve itself
    CHECK(CoatModel(below).dielectric_f0.x == FresnelF0(ior, 0.0));
  }
}

}  // namespace
}  // namespace nacre
