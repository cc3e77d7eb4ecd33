// SPDX-License-Identifier: Apache-2.0
// Plain spheres are read past the tree of JSON values, and nobody can tell: the scene and every
// message are those of the tree.
#include "scene_io/plain_spheres.h"

#include <algorithm>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "catch.h"
#include "scene/hash.h"
#include "scene_io/live_scene.h"
#include "scene_io/load_scene.h"
#include "scene_io/read_scene.h"

namespace nacre {
namespace {

const std::string kSourceFolder = NACRE_SOURCE_DIR;

std::string HashAndNames(const Scene& scene) {
  std::string text = fmt::format("{:x} {} spheres", HashScene(scene), scene.spheres.size());
  for (const Material& material : scene.materials) text += " " + material.name;
  return text;
}

// What comes of a reader: a scene or a message.
template <typename Read>
std::string Outcome(const Read& read) {
  try {
    return HashAndNames(read());
  } catch (const Error& error) {
    return error.what();
  }
}

std::string Outcome(const std::string& text, const LoadOptions& options = {}) {
  return Outcome(
      [&] { return LoadSceneText(text, "scene.json", kSourceFolder + "/scenes", options); });
}

std::string OutcomeByTree(const std::string& text, const LoadOptions& options = {}) {
  return Outcome([&] {
    FaultList faults;
    const SceneTree tree{ParseJson(text, "scene.json", &faults), {}};
    CheckVersion(tree.root, "scene.json");
    Scene scene;
    ReadScene(tree, SceneParts::All(), {kSourceFolder + "/scenes", text.size(), &options, nullptr},
              &faults, &scene);
    ThrowFaults(faults, "scene.json");
    return scene;
  });
}

size_t CountPlain(const std::string& text) {
  FaultList faults;
  PlainSpheres spheres;
  ParseJson(text, "scene.json", &faults, {}, &spheres);
  size_t count = 0;
  for (const SphereRun& run : spheres.runs) count += run.spheres.size();
  return count;
}

std::string SceneOf(const std::string& shapes) {
  return R"({"nacre": 1, "materials": {"red": {"model": "lambert"}, "gr\u00fcn": )"
         R"({"model": "lambert", "albedo": 0.2}}, "shapes": [)" +
         shapes + R"(], "background": 0.5})";
}

class RandomScenes {
 public:
  // Mostly right.
  std::string Shapes() {
    std::string shapes;
    for (size_t i = random_() % 12; i > 0; --i) {
      if (!shapes.empty()) shapes += Blanks() + "," + Blanks();
      shapes += Shape();
    }
    return shapes;
  }

  // Bytes changed, taken out and put in.
  std::string Spoiled(std::string text) {
    constexpr std::string_view kBytes = "{}[],:\"\\-+.0123456789eE ntabcz\x80\xc3\x1f\n";
    for (size_t i = random_() % 3; i > 0; --i) {
      const size_t place = random_() % text.size();
      const char byte = kBytes[random_() % kBytes.size()];
      const size_t kind = random_() % 4;
      if (kind == 0) text.erase(place, 1 + random_() % 30);
      if (kind == 1) text.insert(place, 1, byte);
      if (kind == 2) text[place] = byte;
      if (kind == 3) text.insert(place, text.substr(random_() % text.size(), random_() % 80));
      if (text.empty()) return "[]";
    }
    return text;
  }

 private:
  std::string Pick(const std::vector<std::string>& choices) {
    return choices[random_() % choices.size()];
  }
  bool Seldom() { return random_() % 40 == 0; }
  std::string Blanks() { return Pick({"", "", " ", "\n  ", "\r\n\t"}); }

  std::string Number() {
    if (Seldom()) {
      return Pick({"-0",
                   "-0.0",
                   "0",
                   "01",
                   "1.",
                   ".5",
                   "+1",
                   "1e",
                   "1e400",
                   "-1e400",
                   "1e-400",
                   "4.9406564584124654e-324",
                   "2.2250738585072011e-308",
                   "1e16",
                   "-1e15",
                   "nan",
                   "18446744073709551615",
                   "18446744073709551616",
                   "9007199254740993",
                   "\"1\"",
                   "0.1000000000000000055511151231257827021181583404541015625",
                   "0e5",
                   "-",
                   "1E+2",
                   "null",
                   "[1]"});
    }
    return Pick({fmt::format("{}", std::uniform_real_distribution<>(0.1, 9)(random_)),
                 fmt::format("{}", 1 + random_() % 9),
                 fmt::format("{:e}", 0.01 + static_cast<double>(random_() % 9))});
  }

  std::string Shape() {
    if (Seldom()) return Pick({"{}", "3", "{\"type\": \"icosphere\"}", "[]", "null", "\"sphere\""});
    if (random_() % 9 == 0) {
      return R"({"type": "icosphere", "center": [0, 1, 2], "radius": 1, "material": "red"})";
    }
    std::vector<std::string> members = {
        Seldom() ? Pick({R"("type": "spheres")", R"("type": 3)", R"("t\u0079pe": "sphere")"})
                 : R"("type":)" + Blanks() + R"("sphere")",
        R"("center": [)" + Number() + Blanks() + "," + Number() + "," + Blanks() + Number() + "]",
        R"("radius")" + Blanks() + ":" + Blanks() + Number(),
        Pick({R"("material": "red")", R"("material": "red")", R"("material": "grün")",
              R"("material": "gr\u00fcn")"})};
    if (random_() % 9 == 0) members[3] = R"("material": {"model": "lambert", "albedo": 0.1})";
    if (Seldom()) members[3] = R"("material": "rad")";
    if (Seldom()) members.push_back(R"("radius": 2)");
    if (Seldom()) members.push_back(R"("colour": "red")");
    if (Seldom()) members.erase(members.begin() + static_cast<ptrdiff_t>(random_() % 4));
    std::shuffle(members.begin(), members.end(), random_);
    std::string shape = "{" + Blanks();
    for (size_t i = 0; i < members.size(); ++i) {
      shape += (i > 0 ? "," + Blanks() : "") + members[i] + Blanks();
    }
    return shape + "}";
  }

  std::mt19937 random_{5};
};

TEST_CASE("Scenes of plain spheres are read as by the tree", "[plain_spheres]") {
  RandomScenes scenes;
  size_t plain = 0, right = 0;
  constexpr size_t kScenes = 3000;
  for (size_t i = 0; i < kScenes; ++i) {
    std::string text = SceneOf(scenes.Shapes());
    if (i % 2 == 0) text = scenes.Spoiled(text);
    CAPTURE(text);
    const std::string outcome = Outcome(text);
    REQUIRE(outcome == OutcomeByTree(text));
    if (outcome.starts_with("error")) continue;
    ++right;
    plain += CountPlain(text);
  }
  CHECK(right > kScenes / 4);
  CHECK(plain > right);
}

TEST_CASE("Limits and twice-named shapes are told as by the tree", "[plain_spheres]") {
  const std::string sphere =
      R"({"type": "sphere", "center": [1, 2, 3], "radius": 1, "material": "red"})";
  const std::string five = sphere + "," + sphere + "," + sphere + ",\n" + sphere + "," + sphere;
  REQUIRE(CountPlain(SceneOf(five)) == 4);
  LoadOptions options;
  for (const uint64_t most : {0, 1, 4, 5}) {
    options.max_primitives = most;
    CHECK(Outcome(SceneOf(five), options) == OutcomeByTree(SceneOf(five), options));
  }
  for (const std::string& text :
       {R"({"nacre": 1, "shapes": [)" + five + R"(], "shapes": [)" + five + "]}",
        R"({"nacre": 1, "shapes": {}, "shapes": [)" + five + "]}",
        R"({"nacre": 1, "lights": [)" + five + R"(], "shapes": [{"shapes": [)" + five + "]}]}",
        R"({"nacre": 1, "shapes": [)" + five + R"(], "x": "\q"})", "[" + five + "]",
        R"({"nacre": 1, "shapes": [)" + five + R"(, {"radius": 1e999}]})",
        R"({"nacre": 1, "shapes": [)" + five + R"(, {"a": 1, "a": 2}]})"}) {
    CAPTURE(text);
    CHECK(Outcome(text) == OutcomeByTree(text));
  }
}

TEST_CASE("The table of bad scenes is told as by the tree", "[plain_spheres]") {
  std::ifstream file(kSourceFolder + "/tests/scene_io/bad_scenes.json");
  const Json table = Json::parse(file);
  for (const Json& test_case : table["cases"]) {
    if (!test_case.contains("set")) continue;
    Json scene = table["base"];
    for (const auto& [pointer, value] : test_case["set"].items()) {
      scene[Json::json_pointer(pointer)] = value;
    }
    const std::string text = scene.dump();
    CAPTURE(text);
    CHECK(Outcome(text) == OutcomeByTree(text));
  }
}

TEST_CASE("Plain spheres can be changed one by one", "[plain_spheres]") {
  RandomScenes scenes;
  std::string shapes = R"({"type": "sphere", "center": [1, 2, 3], "radius": 1, "material": "red"})";
  for (int i = 0; i < 20; ++i) {
    shapes += fmt::format(
        R"(,{{"type": "sphere", "center": [1, 2, {}], "radius": 1.5, "material": "red"}})", i);
  }
  const std::string text = SceneOf(shapes);
  REQUIRE(CountPlain(text) == 20);
  const auto change = [&](const std::string& pointer, const std::string& value) {
    LoadOptions options;
    LiveScene live(text, "scene.json", kSourceFolder, options);
    options.overrides = {{pointer, value}};
    const std::string changed = Outcome(text, options);
    CHECK(Outcome([&] {
            live.Set(pointer, value);
            return live.scene();
          }) ==
          Outcome([&] { return LiveScene(text, "scene.json", kSourceFolder, options).scene(); }));
    return changed;
  };
  std::string other = text;
  const std::string center = "[1, 2, 7]";
  other.replace(other.find(center), center.size(), "[5, 2, 7]");
  CHECK(change("/shapes/8/center/0", "5") == Outcome(other));
  CHECK(change("/shapes/20/radius", "2") != Outcome(text));
  CHECK(change("/shapes/20/radius", "1.5") == Outcome(text));
  CHECK(change("/shapes/21/radius", "1").find("the array has 21") != std::string::npos);
  CHECK(change("/shapes", "[]") == Outcome(SceneOf("")));
  CHECK(change("/materials/red/albedo", "0.25") != Outcome(text));
  CHECK(change("/materials/red", "null").find("expected an object") != std::string::npos);
  // The materials change places, which shapes go by.
  CHECK(change("/materials", R"({"other": {"model": "lambert"}, "red": {"model": "lambert"}})") !=
        Outcome(text));
}

}  // namespace
}  // namespace nacre
