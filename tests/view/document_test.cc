// SPDX-License-Identifier: Apache-2.0
// view/document_test.cc: the scene that pages edit: its history, and what is refused.
#include "view/document.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include <catch2/catch.hpp>
#include <unistd.h>

#include "base/error.h"

namespace nacre {
namespace {

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

std::filesystem::path TemporaryFile() {
  return std::filesystem::temp_directory_path() /
         ("nacre_view_document_test_" + std::to_string(getpid()) + ".json");
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
