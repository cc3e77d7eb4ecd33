// SPDX-License-Identifier: Apache-2.0
// tests/api/fresh_process_test.cc: random sequences of changes of a session, each picture of it
// against that of a process which is given all changes at once.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include "catch.h"
#include "nacre.h"

namespace {

struct Change {
  const char* pointer;
  std::vector<const char*> values;
};

// For every scene here; those of its own follow.
const std::vector<Change> kOfEveryScene = {
    {"/camera/position", {"[0, 1, 9]", "[1, 2, 11]", "[-3, 0.5, 8]", "[0, 40, 120]"}},
    {"/camera/fov_y_deg", {"20", "35"}},
    {"/image/spp", {"1", "3"}},
    {"/image/shadows", {"true", "false"}},
    {"/image/filter", {R"({"type": "box"})", R"({"type": "mitchell", "width": 4})"}},
    {"/background", {"0", "[0.1, 0.2, 0.3]"}},
    {"/lights/more",
     {R"({"type": "point", "position": [3, 4, 5], "intensity": 30})",
      R"({"type": "sphere", "center": [-1, 3, 2], "radius": 0.4, "radiance": 9})",
      R"({"type": "rectangle", "center": [0, 4, 2], "facing": [0, -1, 0], "width": 1,
          "height": 2, "radiance": 5})"}},
    {"/lights/other", {R"({"type": "ambient", "radiance": 0.2})"}}};

struct Subject {
  const char* scene;
  std::vector<Change> changes;
};

// Those that take long to read and to render are the last three.
const std::vector<Subject> kSubjects = {
    {"first_scene.json",
     {{"/materials/red/roughness", {"0", "0.05", "0.4"}},
      {"/materials/red", {R"({"model": "phong", "shininess": 30})", R"({"model": "lambert"})"}},
      {"/shapes/0/radius", {"1", "0.7"}},
      {"/shapes/0/material", {"\"floor\"", "\"red\""}}}},
    {"material_grid.json",
     {{"/shapes/0/material/base_color", {"[0.2, 0.3, 0.9]", "0.5"}},
      {"/shapes/0/rows/count", {"2", "5"}}}},
    {"skies.json",
     {{"/lights/sky/rotate_deg", {"0", "30"}}, {"/materials/metal/metallic", {"0", "1"}}}},
    {"textures.json",
     {{"/materials/knot/roughness", {"0.3", "0.9"}},
      {"/materials/knot/normal_map", {"\"tiles_normal\"", "null"}},
      {"/textures/boxed/scale", {"5", "1"}},
      {"/shapes/3/transform/scale", {"0.5", "0.9"}}}},
    {"mesh_lights.json",
     {{"/lights/knot/radiance", {"3", "9"}},
      {"/lights/knot/visible", {"true", "false"}},
      {"/lights/die/icosphere/subdivisions", {"0", "1"}}}},
    {"models/pawns.glb", {{"/materials/brass/roughness", {"0.1", "0.6"}}}}};

std::string Quoted(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

// The picture of a process that is given the changes in their order.
nacre::Image RenderByProcess(const std::string& scene,
                             const std::vector<std::pair<std::string, std::string>>& changes,
                             const std::string& output) {
  std::string command = Quoted(NACRE_PROGRAM) + " render " + Quoted(scene) + " -o " +
                        Quoted(output) +
                        " --size 40x24 --layers all --depth float --compression none --quiet";
  for (const auto& [pointer, value] : changes) {
    command += " --set " + Quoted(pointer + "=" + value);
  }
  INFO(command);
  REQUIRE(std::system(command.c_str()) == 0);
  return nacre::Read(output);
}

void CheckEqual(const nacre::Image& session, const nacre::Image& process) {
  for (const nacre::Channel& channel : process.channels) {
    INFO(channel.name);
    const nacre::Channel* const own = session.Find(channel.name);
    REQUIRE(own != nullptr);
    REQUIRE(own->samples == channel.samples);
  }
  REQUIRE(session.metadata.at("nacre:sceneHash") == process.metadata.at("nacre:sceneHash"));
  REQUIRE(session.channels.size() == process.channels.size());
}

TEST_CASE("sessions have the bits of fresh processes, in hundreds of sequences of changes") {
  const std::string output = (std::filesystem::temp_directory_path() /
                              ("nacre_fresh_process_test_" + std::to_string(getpid()) + ".exr"))
                                 .string();
  nacre::RenderSettings settings{.width = 40, .height = 24, .layers = {"all"}};
  std::minstd_rand random(5);
  int refused = 0;
  for (size_t sequence = 0; sequence < 216; ++sequence) {
    const size_t turn = sequence % 4;
    const Subject& subject = kSubjects[turn < 3 ? turn : 3 + sequence / 4 % 3];
    const std::string path = NACRE_SOURCE_DIR "/scenes/" + std::string(subject.scene);
    std::vector<Change> changes = subject.changes;
    changes.insert(changes.end(), kOfEveryScene.begin(), kOfEveryScene.end());
    nacre::Session session(nacre::Scene::FromFile(path));
    std::vector<std::pair<std::string, std::string>> made;
    const size_t count = 1 + random() % 6;
    for (size_t i = 0; i < count; ++i) {
      const Change& change = changes[random() % changes.size()];
      const char* const value = change.values[random() % change.values.size()];
      try {
        session.Set(change.pointer, nacre::Value::Json(value));
        made.emplace_back(change.pointer, value);
      } catch (const nacre::Error&) {
        ++refused;  // the material has another model by now; the scene stays as it was
      }
      // What was made for pictures on the way must not show in the last one.
      if (random() % 3 == 0) session.Render(settings);
    }
    CAPTURE(subject.scene, sequence);
    const nacre::Image last = session.Render(settings);
    CheckEqual(last, RenderByProcess(path, made, output));
  }
  std::filesystem::remove(output);
  CHECK(refused > 0);
  CHECK(refused < 60);
}

}  // namespace
