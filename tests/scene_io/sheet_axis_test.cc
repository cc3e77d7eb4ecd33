// SPDX-License-Identifier: Apache-2.0
// Axes of sheets as people type them, and materials to JSON and back.
#include "scene_io/sheet_axis.h"

#include <functional>

#include "base/error.h"
#include "catch.h"
#include "color/transfer.h"
#include "scene_io/load_scene.h"
#include "scene_io/scene_json.h"

namespace nacre {
namespace {

using Labels = std::vector<std::string>;

SheetAxis Parse(const std::string& text) { return ParseSheetAxis("--rows", text); }

ExitCode CodeOf(const std::function<void()>& action, const std::string& part) {
  try {
    action();
  } catch (const Error& error) {
    INFO(error.what());
    CHECK(std::string(error.what()).find(part) != std::string::npos);
    CHECK_FALSE(error.faults().front().hint.empty());
    return error.code();
  }
  return ExitCode::kOk;
}

TEST_CASE("numbers from one end to the other, both included") {
  const SheetAxis axis = Parse("roughness=0.1:1:4");
  CHECK(axis.name == "roughness");
  REQUIRE(axis.values.size() == 4);
  CHECK(axis.values.front() == 0.1);
  CHECK(axis.values.back() == 1.0);
  CHECK(axis.values[1].get<double>() == Approx(0.4));
  CHECK(axis.labels == Labels{"0.1", "0.4", "0.7", "1"});
  CHECK(Parse("roughness=0.3:0.9:1").values == std::vector<Json>{0.3});
}

TEST_CASE("numbers at equal ratios") {
  const SheetAxis axis = Parse("shininess=1:1024:6:log");
  CHECK(axis.labels == Labels{"1", "4", "16", "64", "256", "1024"});
  CHECK(axis.values.back() == 1024.0);
  CHECK(CodeOf([] { Parse("shininess=0:64:3:log"); }, "0") == ExitCode::kUsage);
}

TEST_CASE("colours by code, by components and mixed in linear light") {
  const SheetAxis list = Parse("base_color=#ff0000,[0.8,0.2,0.1],#08f,0.5");
  CHECK(list.labels == Labels{"#ff0000", "0.8 0.2 0.1", "#08f", "0.5"});
  CHECK(list.values[0] == Json({1.0, 0.0, 0.0}));
  CHECK(list.values[2] == Json({0.0, SrgbEotf(0x88 / 255.0), 1.0}));
  const SheetAxis mixed = Parse("base_color=#ff0000:[0,0,1]:3");
  CHECK(mixed.values[1] == Json({0.5, 0.0, 0.5}));
}

TEST_CASE("choices and whole materials") {
  SheetAxis choice = Parse("shadowing=height_correlated,separable");
  CheckSheetAxis("--rows", {Json{{"model", "metallic_roughness"}}}, &choice);
  CHECK(choice.kind == SheetAxis::Kind::kChoice);
  const SheetAxis models = Parse("material=phong,blinn_phong");
  CHECK(models.kind == SheetAxis::Kind::kMaterial);
  CHECK(models.values[1] == Json{{"model", "blinn_phong"}});
  const SheetAxis list =
      Parse(R"(material=[{"model":"phong","shininess":8,"name":"soft"}, "lambert"])");
  CHECK(list.labels == Labels{"soft", "lambert"});
  CHECK(list.values[0] == Json{{"model", "phong"}, {"shininess", 8}});
  const SheetAxis objects = Parse(R"(material={"model":"lambert"},{"model":"phong","ks":[0,0,1]})");
  CHECK(objects.labels == Labels{"lambert", "phong"});
}

TEST_CASE("what is no axis is a usage error") {
  for (const char* text :
       {"", "roughness", "roughness=", "=1:2:3", "roughness=0.1:0.9:0", "roughness=0.1:0.9:65",
        "roughness=0.1:0.9:-1", "roughness=0.1:0.9:2.5", "roughness=0.1:0.9:5:cubic",
        "roughness=a b", "base_color=#12345", "base_color=#12345g", "base_color=[1,2]",
        "roughness=1,,2", "material={\"model\"", "roughness=x:1:3", "roughness=0:1:3:log:log"}) {
    INFO(text);
    CHECK(CodeOf([&] { Parse(text); }, "--rows") == ExitCode::kUsage);
  }
  std::string many = "roughness=0";
  for (int i = 0; i < kMaxSheetCount; ++i) many += ",0";
  CHECK(CodeOf([&] { Parse(many); }, "65 values") == ExitCode::kUsage);
}

TEST_CASE("values that the material cannot take are bad input") {
  const std::vector<Json> metal = {Json{{"model", "metallic_roughness"}}};
  const auto check = [&](const std::string& text, const std::string& part) {
    INFO(text);
    SheetAxis axis = Parse(text);
    CHECK(CodeOf([&] { CheckSheetAxis("--rows", metal, &axis); }, part) == ExitCode::kBadInput);
  };
  check("roughnes=0:1:2", "did you mean \"roughness\"");
  check("shininess=1:2:2", "no parameter \"shininess\"");
  check("roughness=0:2:3", "out of range");
  check("roughness=[0,0,1],1", "no value of roughness");
  check("base_color=[0,0,7],1", "out of range");
  check("shadowing=smith", "no shadowing");
  check("shadowing=1,2", "no shadowing");
  check("material=pong,lambert", "did you mean \"phong\"");
  SheetAxis axis = Parse("shininess=1:2:2");
  CHECK(CodeOf(
            [&] {
              CheckSheetAxis("--rows", {Json{{"model", "phong"}}, metal[0]}, &axis);
            },
            "metallic_roughness has no parameter") == ExitCode::kBadInput);
}

TEST_CASE("materials survive the way through JSON") {
  const Json json = {{"model", "phong"}, {"color", {0.8, 0.2, 0.2}}, {"ka", 0.96}, {"kd", 0.96},
                     {"ks", 0.04},       {"shininess", 19.0}};
  CHECK(MaterialJson(LoadMaterialText(JsonText(json), "test")) == json);
  const Json chosen = MaterialJson(
      LoadMaterialText(R"({"model": "metallic_roughness", "shadowing": "separable"})", "test"));
  CHECK(chosen["shadowing"] == "separable");
  CHECK_FALSE(chosen.contains("compensation"));  // the default
  CHECK(DescribeMaterial(json) ==
        "phong: color 0.8 0.2 0.2, ka 0.96, kd 0.96, ks 0.04, shininess 19");
  CHECK_THROWS_AS(LoadMaterialText(R"({"model": "fong"})", "test"), Error);
}

}  // namespace
}  // namespace nacre
