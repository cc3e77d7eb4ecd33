// SPDX-License-Identifier: Apache-2.0
// The table of material parameters against the structs that it is about.
#include "scene/material_parameters.h"

#include <cmath>
#include <set>
#include <string>

#include "catch.h"
#include "scene/limits.h"

namespace nacre {
namespace {

TEST_CASE("each model is found by its name and recognised in its materials") {
  for (const MaterialModel& model : MaterialModels()) {
    INFO(model.name);
    CHECK(FindModel(model.name) == &model);
    CHECK(ModelOf(model.make()) == &model);
  }
  CHECK(FindModel("split") == nullptr);
  CHECK(FindModel("") == nullptr);
  CHECK(ModelOf(Material{.model = SplitMaterial{}}) == nullptr);
}

TEST_CASE("what is set is got, and nothing else changes") {
  for (const MaterialModel& model : MaterialModels()) {
    std::set<std::string_view> names;
    for (const MaterialParameter& parameter : model.parameters) {
      INFO(model.name << " " << parameter.name);
      CHECK(names.insert(parameter.name).second);
      CHECK(FindParameter(model, parameter.name) == &parameter);

      Material material = model.make();
      const Rgb before = parameter.get(material);
      CHECK(parameter.range.Contains(before.x));
      const Rgb value = parameter.is_color ? Rgb(0.125, 0.25, 0.375) : Rgb(0.125, 0.125, 0.125);
      parameter.set(material, value);
      CHECK(parameter.get(material) == value);
      for (const MaterialParameter& other : model.parameters) {
        if (&other == &parameter) continue;
        const bool follows = other.name == "diffuse_roughness" && parameter.name == "roughness";
        CHECK(other.get(material) == (follows ? value : other.get(model.make())));
      }
      CHECK(ModelOf(material) == &model);
    }
  }
}

TEST_CASE("names mean the fields of the same name") {
  Material material = FindModel("metallic_roughness")->make();
  FindParameter(*ModelOf(material), "roughness")->set(material, Rgb(0.25, 0.25, 0.25));
  FindParameter(*ModelOf(material), "base_color")->set(material, Rgb(1, 0.5, 0));
  FindParameter(*ModelOf(material), "emission")->set(material, Rgb(3, 2, 1));
  const auto& metal = std::get<MetallicRoughnessMaterial>(material.model);
  CHECK(metal.roughness == 0.25);
  CHECK(metal.metallic == 0);
  CHECK(metal.base_color == Rgb(1, 0.5, 0));
  CHECK(material.emission == Rgb(3, 2, 1));

  material = FindModel("blinn_phong")->make();
  FindParameter(*ModelOf(material), "ks")->set(material, Rgb(0.1, 0.2, 0.3));
  CHECK(std::get<PhongMaterial>(material.model).ks == Rgb(0.1, 0.2, 0.3));
  CHECK(std::get<PhongMaterial>(material.model).model == PhongModel::kBlinnPhong);
}

TEST_CASE("options are in the order of the enumerations") {
  Material material = FindModel("metallic_roughness")->make();
  const MaterialChoice& shadowing = ModelOf(material)->choices[0];
  REQUIRE(shadowing.options.size() == 4);
  const std::pair<std::string_view, Shadowing> names[] = {
      {"height_correlated", Shadowing::kHeightCorrelated},
      {"separable", Shadowing::kSeparable},
      {"schlick_direct", Shadowing::kSchlickDirect},
      {"schlick_ibl", Shadowing::kSchlickIbl}};
  for (size_t i = 0; i < 4; ++i) {
    CHECK(shadowing.options[i] == names[i].first);
    shadowing.set(material, i);
    CHECK(std::get<MetallicRoughnessMaterial>(material.model).shadowing == names[i].second);
  }
  material = FindModel("phong")->make();
  const MaterialChoice& convention = ModelOf(material)->choices[0];
  CHECK(convention.options[0] == "classic");
  CHECK(convention.get(material) == 1);
  convention.set(material, 0);
  CHECK(std::get<PhongMaterial>(material.model).convention == PhongConvention::kClassic);
}

TEST_CASE("what is chosen is got, presets set parameters") {
  for (const MaterialModel& model : MaterialModels()) {
    for (const MaterialChoice& choice : model.choices) {
      INFO(model.name << " " << choice.name);
      for (size_t option = 0; option < choice.options.size(); ++option) {
        Material material = model.make();
        choice.set(material, option);
        if (choice.get != nullptr) CHECK(choice.get(material) == option);
        CHECK(ModelOf(material) == &model);
      }
    }
  }
  Material gold = FindModel("conductor")->make();
  const MaterialChoice& preset = FindModel("conductor")->choices[0];
  REQUIRE(preset.options[0] == "gold");
  preset.set(gold, 0);
  CHECK(std::get<ConductorMaterial>(gold.model).eta == Rgb(0.143, 0.375, 1.442));
  CHECK(std::get<ConductorMaterial>(gold.model).k == Rgb(3.983, 2.386, 1.603));
  Material diamond = FindModel("dielectric")->make();
  REQUIRE(FindModel("dielectric")->choices[0].options[2] == "diamond");
  FindModel("dielectric")->choices[0].set(diamond, 2);
  CHECK(std::get<DielectricMaterial>(diamond.model).ior == 2.417);
}

TEST_CASE("the ends of ranges are within them as floats, too") {
  // Numbers come from float arrays and files: 1e30 as float is above, .001 below that in double.
  const auto check = [](const Range& range) {
    INFO(Describe(range));
    CHECK((range.min_open || range.Contains(static_cast<float>(range.min))));
    CHECK((range.max_open || range.Contains(static_cast<float>(range.max))));
  };
  for (const MaterialModel& model : MaterialModels()) {
    for (const MaterialParameter& parameter : model.parameters) {
      INFO(model.name << " " << parameter.name);
      check(parameter.range);
    }
  }
  for (const Range& range :
       {limits::kCoordinate, limits::kLength, limits::kRadiance, limits::kIor, limits::kEta,
        limits::kExtinction, limits::kExponent, limits::kAttenuation, limits::kCutoffDeg,
        limits::kInnerDeg, limits::kSkyTerm, limits::kTextureScale, limits::kAngleDeg,
        limits::kNormalScale, limits::kFilterWidth, limits::kCreaseAngleDeg}) {
    check(range);
  }
}

TEST_CASE("ranges contain their ends unless they are open, and never NaN") {
  CHECK(limits::kUnit.Contains(0));
  CHECK(limits::kUnit.Contains(1));
  CHECK(!limits::kUnit.Contains(1 + 1e-15));
  CHECK(!limits::kFovYDeg.Contains(0));
  CHECK(!limits::kFovYDeg.Contains(180));
  CHECK(!limits::kUnit.Contains(std::nan("")));
  CHECK(Describe(limits::kUnit) == "from 0 to 1");
  CHECK(Describe(limits::kFovYDeg) == "greater than 0 and less than 180");
  CHECK(Describe(limits::kFilterWidth) == "greater than 0 and at most 16");
}

}  // namespace
}  // namespace nacre
