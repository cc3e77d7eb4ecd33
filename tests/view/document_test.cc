// SPDX-License-Identifier: Apache-2.0
// view/document_test.cc: the scene that pages edit: its history, and what is refused.
#include "view/document.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <unistd.h>

#include "base/error.h"
#include "catch.h"

namespace nacre {
namespace {

std::filesystem::path TemporaryFile() {
  return std::filesystem::temp_directory_path() /
         ("nacre_view_document_test_" + std::to_string(getpid()) + ".json");
}

constexpr char kRoughness[] = "/materials/PBR/roughness";

double Roughness(const ViewDocument& document) {
  return document.Tree().at(Json::json_pointer(kRoughness)).get<double>();
}

TEST_CASE("changes of one gesture are one step") {
  ViewDocument document(LoadOptions{});
  const Json before = document.Tree();
  document.Set(kRoughness, 0.5, 1);
  document.Set(kRoughness, 0.6, 1);
  document.Set(kRoughness, 0.7, 2);
  CHECK(document.Undo());
  CHECK(Roughness(document) == 0.6);
  CHECK(document.Undo());
  CHECK(document.Tree() == before);
  CHECK_FALSE(document.Undo());
  CHECK(document.Redo());
  CHECK(document.Redo());
  CHECK_FALSE(document.Redo());
  CHECK(Roughness(document) == 0.7);
  document.Undo();
  document.Set(kRoughness, 0.1, 3);
  CHECK_FALSE(document.can_redo());
}

constexpr char kColor[] = "/materials/PBR/base_color";

// The document after each of some changes, and that undo and redo walk through these states.
void CheckHistory(ViewDocument* document, const std::vector<Json>& states) {
  for (size_t i = states.size() - 1; i-- > 0;) {
    CAPTURE(i);
    CHECK(document->Undo());
    CHECK(document->Tree() == states[i]);
  }
  CHECK_FALSE(document->Undo());
  for (size_t i = 1; i < states.size(); ++i) {
    CAPTURE(i);
    CHECK(document->Redo());
    CHECK(document->Tree() == states[i]);
  }
  CHECK_FALSE(document->Redo());
}

TEST_CASE("a gesture that changes several values goes and comes back as a whole") {
  ViewDocument document(LoadOptions{});
  std::vector<Json> states = {document.Tree()};
  // Each gesture's changes: the last alone, the first alone, one of two would each leave another
  // scene. Values within one another, and back to what was, too.
  const std::vector<std::vector<std::pair<const char*, Json>>> gestures = {
      {{kRoughness, 0.5}, {kColor, {1, 0, 0}}},
      {{kRoughness, 0.6}, {kColor, {0, 1, 0}}, {kRoughness, 0.7}, {kColor, {0, 0, 1}}},
      {{"/materials/new", {{"model", "lambert"}}},
       {"/materials/new/albedo", 0.25},
       {"/materials/new", {{"model", "lambert"}, {"albedo", 0.5}}},
       {"/materials/new/albedo", 0.75}},
      {{kColor, {1, 1, 1}}, {"/background", 1}, {kColor, {0, 0, 1}}},
      {{"/materials/PBR/metallic", 1}, {"/materials/PBR", {{"model", "lambert"}}}},
  };
  for (size_t i = 0; i < gestures.size(); ++i) {
    for (const auto& [pointer, value] : gestures[i]) document.Set(pointer, value, i + 1);
    states.push_back(document.Tree());
  }
  CheckHistory(&document, states);
  CheckHistory(&document, states);
}

TEST_CASE("an undo that is not possible any more changes nothing") {
  // The second of a gesture's changes, backwards the first, needs a file that is gone.
  const std::filesystem::path folder = TemporaryFile().replace_extension();
  std::filesystem::create_directory(folder);
  const auto texture = [&](const char* name) {
    std::filesystem::copy_file(NACRE_SOURCE_DIR "/scenes/textures/tiles.png", folder / name);
  };
  texture("a.png");
  texture("b.png");
  std::ofstream(folder / "s.json") << R"({"nacre": 1, "textures": {"t": {"file": "a.png"}},
                                         "materials": {"m": {"albedo_map": "t", "model": "lambert"}}})";
  ViewDocument document(folder / "s.json", LoadOptions{});
  document.Set("/textures/t/file", "b.png", 1);
  document.Set("/background", 0.5, 1);
  const Json after = document.Tree();
  std::filesystem::remove(folder / "a.png");
  CHECK_THROWS_AS(document.Undo(), Error);
  CHECK(document.Tree() == after);
  CHECK(document.can_undo());
  texture("a.png");
  CHECK(document.Undo());
  CHECK(document.Tree()["textures"]["t"]["file"] == "a.png");
  CHECK_FALSE(document.Tree().contains("background"));
  std::filesystem::remove_all(folder);
}

TEST_CASE("the history is bounded by number and size") {
  ViewDocument document(LoadOptions{});
  for (int i = 0; i < 2000; ++i) document.Set(kRoughness, i % 2 == 0 ? 0.25 : 0.75, 0);
  int steps = 0;
  while (document.Undo()) ++steps;
  CHECK(steps == 500);
  // A megabyte of names in each.
  const std::string name(size_t{1} << 20, 'x');
  for (int i = 0; i < 80; ++i) {
    document.Set("/materials/" + name, Json{{"model", "lambert"}, {"albedo", i / 80.0}}, 0);
    document.Set("/materials", document.Tree()["materials"], 0);
  }
  steps = 0;
  while (document.Undo()) ++steps;
  CHECK(steps > 10);
  CHECK(steps < 80);
}

TEST_CASE("a pointer of many tokens costs no more than it is long") {
  // What the message's reader lets through, and what it does not: this took minutes.
  ViewDocument document(LoadOptions{});
  std::string pointer;
  for (int i = 0; i < 60000; ++i) pointer += "/a";
  const auto start = std::chrono::steady_clock::now();
  CHECK_THROWS_AS(document.Set(pointer, 1, 1), Error);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(5));
}

TEST_CASE("members that a change has made go with it") {
  ViewDocument document(LoadOptions{});
  const Json before = document.Tree();
  document.Set("/image/filter/type", "gaussian", 1);
  document.Set("/camera", Json{{"position", {0, 0, 5}}}, 2);
  document.Set("/materials/new", Json{{"model", "lambert"}}, 3);
  for (int i = 0; i < 3; ++i) CHECK(document.Undo());
  CHECK(document.Tree() == before);
}

TEST_CASE("a model's lights are changed by their members") {
  ViewDocument document(NACRE_SOURCE_DIR "/scenes/models/pawns.glb", LoadOptions{});
  const Json before = document.Tree();
  REQUIRE(before.at("lights").contains("key"));
  const Json direction = before["lights"]["key"]["direction_of_travel"];
  document.Set("/lights/key/irradiance", 5, 1);
  CHECK(document.Tree()["lights"]["key"]["irradiance"] == 5);
  CHECK(document.Tree()["lights"]["key"]["direction_of_travel"] == direction);
  CHECK(document.Tree()["lights"]["rim"] == before["lights"]["rim"]);
  CHECK_THROWS_AS(document.Set("/lights/rim/irradiance", "bright", 2), Error);
  CHECK(document.Tree()["lights"]["rim"] == before["lights"]["rim"]);
  // The lights that it has not got of its own follow the camera, and are no change.
  document.Set("/camera", Json{{"position", {0, 1, 9}}}, 3);
  CHECK(document.ModelLights()["rim"] != before["lights"]["rim"]);
  CHECK(document.ModelLights()["rim"] == document.OriginalModelLights()["rim"]);
  CHECK(document.ModelLights()["key"] != document.OriginalModelLights()["key"]);
  document.Undo();
  document.Set("/lights/rim/irradiance", 2, 4);
  CHECK(document.Tree()["lights"].size() == before["lights"].size());
  document.Undo();
  CHECK(document.Tree()["lights"]["rim"] == before["lights"]["rim"]);
  CHECK(document.Tree()["lights"]["key"]["irradiance"] == 5);
  document.ReadChangedFiles();
  CHECK(document.Tree()["lights"]["key"]["irradiance"] == 5);
  CHECK(document.Tree()["lights"]["rim"] == before["lights"]["rim"]);
  document.Undo();
  CHECK(document.Tree() == before);
  CHECK_THROWS_AS(document.Set("/lights", Json::object(), 5), Error);
  CHECK(document.Tree() == before);
}

TEST_CASE("edits make the scene again, as one step") {
  struct Case {
    const char* scene;
    std::vector<std::pair<const char*, Json>> edits;
  };
  const std::vector<Case> cases = {
      {"",
       {{kRoughness, 0.5}, {"/materials/PBR", {{"model", "lambert"}}}, {"/camera/fov_y_deg", 20}}},
      {"first_scene.json",
       {{"/materials/red",
         {{"roughness", 0.5},
          {"model", "metallic_roughness"}}},  // without a member, and in another order
        {"/lights/second", {{"type", "ambient"}, {"radiance", 1}}},
        {"/shapes/0/radius", 0.5},
        {"/image/width", 64}}},
      {"models/pawns.glb",
       {{"/lights/key/irradiance", 2},
        {"/lights/sky/scale", 0.5},
        {"/lights/own", {{"type", "point"}, {"position", {1, 2, 3}}, {"intensity", 4}}},
        {"/camera/fov_y_deg", 20},
        {"/background", 0.25}}},
  };
  for (const auto& [scene, edits] : cases) {
    CAPTURE(scene);
    const auto open = [&, scene = scene] {
      if (*scene == 0) return std::make_unique<ViewDocument>(LoadOptions{});
      return std::make_unique<ViewDocument>(std::string(NACRE_SOURCE_DIR "/scenes/") + scene,
                                            LoadOptions{});
    };
    const auto edited = open(), restored = open();
    const Json before = restored->Tree();
    CHECK(edited->Edits().empty());
    for (const auto& [pointer, value] : edits) edited->Set(pointer, value, 0);
    CHECK(restored->Restore(edited->Edits()).empty());
    CHECK(restored->Tree() == edited->Tree());
    CHECK(restored->Undo());
    CHECK(restored->Tree() == before);
    CHECK_FALSE(restored->Undo());
    CHECK(restored->Redo());
    CHECK(restored->Tree() == edited->Tree());
    edited->Reset();
    CHECK(edited->Edits().empty());
    // Those that do not fit are named, the others made.
    std::vector<Edit> some = restored->Edits();
    some.insert(some.begin(), {"/materials/none/roughness", 0.5});
    const auto other = open();
    CHECK(other->Restore(some) == std::vector<std::string>{"/materials/none/roughness"});
    CHECK(other->Tree() == restored->Tree());
  }
}

TEST_CASE("a model's room keeps its picture while it is dimmed and turned") {
  ViewDocument document(NACRE_SOURCE_DIR "/scenes/models/pawns.glb", LoadOptions{});
  const auto sky = [&]() -> const EnvironmentLight& {
    const std::vector<Light>& lights = document.scene().lights;
    return std::get<EnvironmentLight>(
        std::find_if(lights.begin(), lights.end(), [](const Light& light) {
          return light.name == "sky";
        })->kind);
  };
  const std::vector<float> before(std::get<PictureSky>(sky().sky).picture->rgb.begin(),
                                  std::get<PictureSky>(sky().sky).picture->rgb.end());
  CHECK(document.Tree()["lights"]["sky"]["type"] == "environment");
  document.Set("/lights/sky/scale", 0.5, 1);
  document.Set("/lights/sky/rotate_deg", 90, 2);
  CHECK(std::get<PictureSky>(sky().sky).scale == Rgb(0.5));
  CHECK(std::equal(before.begin(), before.end(),
                   std::get<PictureSky>(sky().sky).picture->rgb.begin()));
  CHECK(sky().rotate_deg == 90);
  CHECK_FALSE(sky().background);
  // Another sky in its place.
  document.Set("/lights/sky", Json{{"type", "environment"}, {"radiance", 2}}, 3);
  CHECK(std::get<ConstantSky>(sky().sky).radiance == Rgb(2));
  while (document.Undo()) {
  }
  CHECK(std::get<PictureSky>(sky().sky).scale == Rgb(1));
  // Without the studio there is no room to keep.
  document.Set("", Json{{"lights", {{"own", {{"type", "ambient"}, {"radiance", 1}}}}}}, 4);
  CHECK_NOTHROW(document.Set("/lights/sky/scale", 0.5, 5));
}

TEST_CASE("files of the folder are offered, links that lead out of it are not") {
  const std::filesystem::path folder = TemporaryFile().replace_extension(),
                              outside = folder.string() + "_secret.png";
  std::filesystem::create_directories(folder / "maps");
  for (const std::filesystem::path& file : {folder / "a.png", folder / "maps/b.png", outside})
    std::ofstream(file) << "x";
  std::ofstream(folder / "s.json") << R"({"nacre": 1})";
  std::filesystem::create_symlink("maps/b.png", folder / "inside.png");
  std::filesystem::create_symlink(outside, folder / "outside.png");
  std::filesystem::create_symlink(outside, folder / "maps/outside.png");
  std::filesystem::create_symlink("../a.png", folder / "maps/up.png");
  std::filesystem::create_symlink("none.png", folder / "broken.png");
  const std::filesystem::path link = folder.string() + "_link";
  std::filesystem::create_directory_symlink(folder, link);
  for (const std::filesystem::path& place : {folder, link}) {
    const ViewDocument document(place / "s.json", LoadOptions{});
    CHECK(document.ImageFiles() ==
          std::vector<std::string>{"a.png", "inside.png", "maps/b.png", "maps/up.png"});
  }
  ViewDocument document(folder / "s.json", LoadOptions{});
  CHECK_THROWS_AS(document.Set("/textures/t", Json{{"file", "outside.png"}}, 1), Error);
  for (const std::filesystem::path& path : {folder, link, outside})
    std::filesystem::remove_all(path);
}

TEST_CASE("reset is a step like others") {
  ViewDocument document(LoadOptions{});
  const Json before = document.Tree();
  CHECK_FALSE(document.Reset());
  document.Set(kRoughness, 0.9, 1);
  CHECK(document.Reset());
  CHECK(document.Tree() == before);
  CHECK(document.Undo());
  CHECK(Roughness(document) == 0.9);
}

TEST_CASE("what is refused changes nothing") {
  ViewDocument document(LoadOptions{});
  const Json before = document.Tree();
  CHECK_THROWS_AS(document.Set(kRoughness, 2, 1), Error);
  CHECK_THROWS_AS(document.Set("roughness", 0.5, 1), Error);
  CHECK_THROWS_AS(document.Set("/nowhere/at/all", 0.5, 1), Error);
  CHECK(document.Tree() == before);
  CHECK_FALSE(document.can_undo());
}

Json SphereJson(int i) {
  return {{"type", "sphere"}, {"center", {i, 0, 0}}, {"radius", 0.5}, {"material", "red"}};
}

TEST_CASE("shapes are listed where a change needs it, and never lost") {
  for (const int count : {2, 1500}) {
    CAPTURE(count);
    Json scene = {{"nacre", 1}, {"materials", {{"red", {{"model", "lambert"}}}}}};
    for (int i = 0; i < count; ++i) scene["shapes"].push_back(SphereJson(i));
    const std::filesystem::path path = TemporaryFile();
    std::ofstream(path) << scene.dump();
    ViewDocument document(path, LoadOptions{});
    CHECK(document.lists_all_shapes() == (count == 2));
    CHECK(document.Tree().contains("shapes") == (count == 2));
    document.Set("/materials/red/albedo", 0.25, 1);
    CHECK(document.lists_all_shapes() == (count == 2));
    document.Set("/shapes/1/radius", 0.25, 2);
    CHECK(document.Tree()["shapes"].size() == static_cast<size_t>(count));
    CHECK(document.scene().spheres[1].radius == 0.25);
    CHECK(document.Undo());
    CHECK(document.Undo());
    CHECK(document.Tree() == scene);
    document.Set("/background", 1, 3);
    CHECK(document.Reset());
    CHECK(document.Tree() == scene);
    CHECK(document.scene().spheres.size() == static_cast<size_t>(count));
    std::filesystem::remove(path);
  }
}

TEST_CASE("files are watched") {
  const std::filesystem::path path = TemporaryFile();
  const auto write = [&](const char* text) { std::ofstream(path) << text; };
  write(R"({"nacre": 1})");
  ViewDocument document(path, LoadOptions{});
  CHECK_FALSE(document.FilesChanged());
  write(R"({"nacre": 1, "background": 1})");
  // Once it has been the same for a tenth of a second.
  const auto soon = [&] {
    for (int i = 0; i < 500; ++i) {
      if (document.FilesChanged()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  };
  REQUIRE(soon());
  document.ReadChangedFiles();
  CHECK(document.scene().background == Rgb(1));
  CHECK_FALSE(document.FilesChanged());
  // Edits stay, but for what the file says anew.
  document.Set("/background", 0.5, 1);
  document.Set("/camera/fov_y_deg", 20, 2);
  write(R"({"nacre": 1, "background": 0.25})");
  REQUIRE(soon());
  document.ReadChangedFiles();
  CHECK(document.scene().background == Rgb(0.25));
  CHECK(document.scene().camera.fov_y_deg == 20);
  CHECK_FALSE(document.can_undo());
  CHECK(document.Reset());
  CHECK(document.scene().camera.fov_y_deg != 20);
  write(R"({"nacre": 1, "background": 1})");
  REQUIRE(soon());
  document.ReadChangedFiles();
  std::filesystem::remove(path);
  REQUIRE(soon());
  CHECK_THROWS_AS(document.ReadChangedFiles(), Error);
  CHECK(document.scene().background == Rgb(1));
  CHECK(document.Reset() == false);
}

}  // namespace
}  // namespace nacre
