// SPDX-License-Identifier: Apache-2.0
// Scenes that must be refused, one fault each, from the table bad_scenes.json (which
// schema_test.py holds the JSON Schema against as well).
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "catch.h"
#include "scene_io/load_scene.h"

namespace nacre {
namespace {

using Json = nlohmann::ordered_json;

const std::string kSource = NACRE_SOURCE_DIR;

Json Table() {
  std::ifstream file(kSource + "/tests/scene_io/bad_scenes.json");
  return Json::parse(file);
}

std::string Text(const Json& base, const Json& test_case) {
  if (test_case.contains("text")) return test_case["text"];
  Json scene = base;
  const Json set = test_case.value("set", Json::object());
  for (const auto& [pointer, value] : set.items()) {
    scene[Json::json_pointer(pointer)] = value;
  }
  const Json remove = test_case.value("remove", Json::array());
  for (const Json& pointer : remove) {
    const Json::json_pointer place(pointer.get<std::string>());
    scene[place.parent_pointer()].erase(place.back());
  }
  return scene.dump();
}

bool Contains(const std::string& text, const Json& part) {
  return text.find(part.get<std::string>()) != std::string::npos;
}

// `where` ends with the expected place: the fault is told there, not somewhere below it.
bool IsAt(const std::string& where, const Json& expected) {
  const auto place = expected.get<std::string>();
  return place.starts_with("bad.json:") ? where.starts_with(place) : where.ends_with(place);
}

std::vector<Fault> FaultsOf(const std::string& text) {
  try {
    LoadSceneText(text, "bad.json", kSource + "/scenes");
  } catch (const Error& error) {
    CHECK(error.code() == ExitCode::kBadInput);
    return error.faults();
  }
  return {};
}

TEST_CASE("the base of the bad scenes is a good scene") {
  CHECK_NOTHROW(LoadSceneText(Table()["base"].dump(), "base.json", kSource + "/scenes"));
}

TEST_CASE("bad scenes are refused with the place, the fault and a hint") {
  const Json table = Table();
  CHECK(table["cases"].size() >= 50);
  for (const Json& test_case : table["cases"]) {
    const std::vector<Fault> faults = FaultsOf(Text(table["base"], test_case));
    bool found = false;
    std::string told;
    for (const Fault& fault : faults) {
      told += fault.where + " | " + fault.what + " | " + fault.hint + "\n";
      CHECK(fault.where.starts_with("bad.json"));
      found = found ||
              (IsAt(fault.where, test_case["where"]) && Contains(fault.what, test_case["what"]) &&
               Contains(fault.hint, test_case["hint"]));
    }
    INFO(test_case.dump() << "\nwas told:\n" << told);
    CHECK(found);
    if (!test_case.contains("more")) CHECK(faults.size() == 1);  // nothing wrong is told besides
  }
}

TEST_CASE("all faults of a scene are told at once") {
  Json scene = Table()["base"];
  scene["image"]["width"] = 0;
  scene["camera"]["up"] = {0, 0, 1};  // found by Validate, not by the reader
  scene["materials"]["red"]["roughness"] = 2;
  scene["shapes"][0]["radius"] = "1";
  const std::vector<Fault> faults = FaultsOf(scene.dump());
  REQUIRE(faults.size() == 4);
  CHECK(faults[0].where == "bad.json: /image/width");
  CHECK(faults[1].where == "bad.json: /materials/red/roughness");
  CHECK(faults[2].where == "bad.json: /shapes/0/radius");
  CHECK(faults[3].where == "bad.json: /camera/up");
}

TEST_CASE("a thousand faults are cut short") {
  Json scene = Table()["base"];
  for (int i = 0; i < 1000; ++i) scene["shapes"].push_back({{"type", "sphere"}});
  const std::vector<Fault> faults = FaultsOf(scene.dump());
  REQUIRE(faults.size() == 21);
  CHECK(faults.back().where == "bad.json");
  CHECK(faults.back().what == "and 2980 more faults");  // three missing keys each, 20 told
}

TEST_CASE("nesting is allowed to a depth of 100") {
  const auto nested = [](size_t depth) {
    return R"({"nacre": 1, "background": )" + std::string(depth - 1, '[') +
           std::string(depth - 1, ']') + "}";
  };
  const std::vector<Fault> deep = FaultsOf(nested(100));
  REQUIRE(deep.size() == 1);
  CHECK(deep[0].what == "expected three numbers, got an array of 1");
  for (const size_t depth : {size_t{101}, size_t{1000000}}) {
    const std::vector<Fault> too_deep = FaultsOf(nested(depth));
    REQUIRE(too_deep.size() == 1);
    CHECK(too_deep[0].what == "nested deeper than 100 levels");
    CHECK(too_deep[0].where.starts_with("bad.json: /background/0/0"));
  }
}

}  // namespace
}  // namespace nacre
