// SPDX-License-Identifier: Apache-2.0
// tests/shading/open_pbr_material_test.cc: options and versions of OpenPBR, one by one, against
// their formulas.
#include <cmath>

#include "catch.h"
#include "scene/material.h"
#include "scene/material_parameters.h"
#include "shading/coat_transmission.h"
#include "shading/material.h"
#include "shading/open_pbr.h"

namespace nacre {
namespace {

ShadingMaterial PreparedOpenPbr(const OpenPbrMaterial& model) {
  static Material material;  // outlives what is prepared of it
  material = Material{};
  material.model = model;
  return PrepareMaterial(material);
}

TEST_CASE("a coat changes a metal as film_metal's index has it") {
  OpenPbrMaterial gold{.base_color = {0.929, 0.788, 0.374}, .base_metalness = 1, .coat_weight = 1};
  gold.options.coat_metal = CoatMetal::kGulbrandsen;
  const auto f0 = [&] { return std::get<MicrofacetModel>(PreparedOpenPbr(gold).model).metal_f0; };
  // Of a real index n, seen from n / 1.6: three decimals of a table of implementations.
  gold.options.film_metal = FilmMetal::kRealIndex;
  const Rgb real = f0();
  CHECK(std::abs(real.x - 0.889) < 5.1e-4);
  CHECK(std::abs(real.y - 0.683) < 5.1e-4);
  CHECK(std::abs(real.z - 0.197) < 5.1e-4);
  // Half a coat is half the way.
  gold.coat_weight = 0.5;
  CHECK(std::abs(f0().z - (0.374 + real.z) / 2) < 1e-12);
  // As in air: without a coat, below one of index 1, and unless it is asked for.
  gold.coat_weight = 0;
  CHECK(f0() == gold.base_color);
  gold.coat_weight = 1;
  gold.coat_ior = 1;
  CHECK(std::abs(f0().y - 0.788) < 1e-12);
  gold.coat_ior = 1.6;
  gold.options.coat_metal = CoatMetal::kUnchanged;
  CHECK(f0() == gold.base_color);
}

// The factors on emission under a coat of weight C = 1/2 and colour 1/4, at n.v.
TEST_CASE("emission passes coats by four rules") {
  OpenPbrMaterial model{.coat_weight = 0.5, .coat_color = Rgb(0.25)};
  CoatTransmission coat = TransmissionOf(model);
  const Rgb albedo(0.04);
  const auto left = [&](EmissionThrough rule, double n_dot_v) {
    return EmittedThroughCoat(rule, coat, albedo, n_dot_v).x;
  };
  const auto lerp = [](double t) { return 1 + (t - 1) * 0.5; };
  CHECK(left(EmissionThrough::kCoatPath, 1) == Approx(lerp(0.5)).epsilon(1e-14));
  // Seen at 60 degrees, the path in an index of 1.6 is 1 / sqrt(1 - 3 / 4 / 1.6^2) as long.
  const double length = 1 / std::sqrt(1 - 0.75 / 2.56);
  CHECK(left(EmissionThrough::kCoatPath, 0.5) ==
        Approx(lerp(std::pow(0.5, length))).epsilon(1e-14));
  CHECK(left(EmissionThrough::kCoatColor, 0.5) == Approx(lerp(0.25)).epsilon(1e-14));
  const double f0 = std::pow(0.6 / 2.6, 2);
  CHECK(left(EmissionThrough::kMaterialX, 0.5) ==
        Approx(lerp(0.25 * (1 - f0) * (1 - 1.0 / 32))).epsilon(1e-14));
  CHECK(left(EmissionThrough::kMaterialX, 0) == Approx(0.5).epsilon(1e-14));
  coat.darkening = 0;
  CHECK(left(EmissionThrough::kBaseFactors, 1) == Approx(0.96 * lerp(0.5)).epsilon(1e-14));
  coat.darkening = 1;
  const double k = coat.of_rough_base * coat.base_roughness + (1 - coat.base_roughness) * f0;
  const double darkened = (1 - k) / (1 - coat.base_albedo.x * k);
  CHECK(left(EmissionThrough::kBaseFactors, 1) ==
        Approx(0.96 * lerp(0.5) * lerp(darkened)).epsilon(1e-12));
  // A colourless coat that covers all leaves all, but for what it reflects.
  model.coat_color = Rgb(1);
  model.coat_weight = 1;
  coat = TransmissionOf(model);
  CHECK(left(EmissionThrough::kCoatPath, 0.2) == 1);
  CHECK(left(EmissionThrough::kCoatColor, 0.2) == 1);
}

TEST_CASE("fuzz attenuates emission by Adobe's rules alone") {
  OpenPbrMaterial model{.fuzz_weight = 1, .emission_luminance = 2};
  CHECK_FALSE(PreparedOpenPbr(model).by_hit.parameters);
  model.options = OptionsOf(OpenPbrRules::kAdobe);
  CHECK(PreparedOpenPbr(model).by_hit.parameters);
}

TEST_CASE("version 1.2 has the defaults of its text") {
  const MaterialModel& row = *FindModel("open_pbr");
  const auto version = std::ranges::find(row.choices, "version", &MaterialChoice::name);
  REQUIRE(version != row.choices.end());
  REQUIRE(version == row.choices.begin());  // before the options that it sets
  Material material = row.make();
  CHECK(EmissionOf(material) == Rgb(0));
  version->set(material, 1);
  auto& model = std::get<OpenPbrMaterial>(material.model);
  CHECK(EmissionOf(material) == Rgb(0));
  model.emission_weight = 0.5;
  model.emission_color = Rgb(2, 1, 0);  // which may exceed 1
  CHECK(EmissionOf(material) == Rgb(1000, 500, 0));
  CHECK(model.options.coat_darkening_rule == CoatDarkening::kSpec12);
  CHECK(model.options.coat_partial == CoatPartial::kWholeProduct);
  version->set(material, 0);
  CHECK(model.emission_weight == 1);
  CHECK(model.options.coat_partial == CoatPartial::kExponentThenLerp);
}

}  // namespace
}  // namespace nacre
