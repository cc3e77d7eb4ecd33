// SPDX-License-Identifier: Apache-2.0
// tests/render/settings_test.cc: the table of the settings that people can give.
#include "render/settings.h"

#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <variant>

#include "base/error.h"
#include "catch.h"

using namespace nacre;

namespace {

// The error of CheckSettings as text; empty if there is none.
std::string Refusal(const RenderSettings& settings) {
  try {
    CheckSettings(settings);
  } catch (const Error& error) {
    CHECK(error.code() == ExitCode::kUsage);
    const Fault& fault = error.faults().front();
    return fault.where + ": " + fault.what + "; " + fault.hint;
  }
  return {};
}

}  // namespace

TEST_CASE("each setting has a name, a meaning and a range of its own") {
  std::set<std::string_view> names;
  for (const SettingKey& key : SettingKeys()) {
    INFO(key.name);
    CHECK(names.insert(key.name).second);
    CHECK(&SettingNamed(key.name) == &key);
    CHECK_FALSE(key.meaning.empty());
    const bool is_number = std::holds_alternative<double RenderSettings::*>(key.field) ||
                           std::holds_alternative<int RenderSettings::*>(key.field);
    CHECK(is_number == (key.range.min < key.range.max));
    const bool is_text = std::holds_alternative<SettingText>(key.field);
    CHECK((!is_text || !key.form.empty()));
  }
  CHECK(OptionOf(SettingNamed("tile_size")) == "--tile-size");
}

TEST_CASE("settings out of range are told with their range") {
  RenderSettings settings;
  CHECK(Refusal(settings).empty());
  for (const double error : {2.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    settings.max_error = error;
    CHECK(Refusal(settings) ==
          "RenderSettings::max_error: is out of range; it is 0 or from 1e-06 to 1");
  }
  settings.max_error = 1;
  settings.threads = 1025;
  CHECK(Refusal(settings) == "RenderSettings::threads: is out of range; it is from 0 to 1024");
}

TEST_CASE("choices and texts are parsed") {
  RenderSettings settings;
  SetChoice(SettingNamed("intersector"), "shells", &settings);
  CHECK(settings.intersector == IntersectorChoice::kShells);
  CHECK_THROWS_AS(SetChoice(SettingNamed("intersector"), "bvh", &settings), Error);
  const auto parse = [&](const char* name, const std::string& text) {
    std::get<SettingText>(SettingNamed(name).field).parse(text, &settings);
  };
  parse("region", "1,2,30,40");
  CHECK(settings.region == Window{1, 2, 30, 40});
  for (const char* text : {"", "1,2,3", "1,2,3,4,5", "1,2,1,4", "1,2,3,2", "1,2,3,4,", "a,2,3,4"}) {
    CHECK_THROWS_AS(parse("region", text), Error);
  }
  parse("tile", "1/3");
  CHECK(settings.band.index == 1);
  CHECK(settings.band.count == 3);
  for (const char* text : {"", "3/3", "-1/3", "1", "1/3/5", "1/x", "0/0"}) {
    CHECK_THROWS_AS(parse("tile", text), Error);
  }
}

TEST_CASE("only settings that pictures depend on are told of them, and only if they are changed") {
  RenderSettings settings{.threads = 3, .tile_size = 16, .intersector = IntersectorChoice::kTiles};
  CHECK(ChangedSettings(settings).empty());
  settings.max_error = 0.25;
  const auto changed = ChangedSettings(settings);
  REQUIRE(changed.size() == 1);
  CHECK(changed[0].first == "max_error");
  CHECK(changed[0].second == SettingValue(0.25f));
}
