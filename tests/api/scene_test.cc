// SPDX-License-Identifier: Apache-2.0
// tests/api/scene_test.cc: scenes of the public API, which includes nothing but nacre.h.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "catch.h"
#include "nacre.h"

namespace {

const std::string kFirstScene = NACRE_SOURCE_DIR "/scenes/first_scene.json";

// scenes/first_scene.json, in code.
nacre::Scene BuildFirstScene() {
  nacre::Scene scene;
  scene.SetCamera({{"position", {0, 1.6, 6}}, {"look_at", {0, 0.9, 0}}, {"fov_y_deg", 32}});
  scene.AddMaterial(
      "red",
      {{"model", "metallic_roughness"}, {"base_color", {0.8, 0.1, 0.08}}, {"roughness", 0.3}});
  scene.AddMaterial("floor", {{"model", "lambert"}, {"albedo", 0.5}});
  scene.AddLight("key", {{"type", "point"}, {"position", {3, 5, 4}}, {"intensity", 140}});
  scene.AddLight("sky", {{"type", "ambient"}, {"radiance", {0.1, 0.11, 0.13}}});
  scene.AddSphere({0, 1, 0}, 1, "red");
  scene.AddSphere({0, -1000, 0}, 1000, "floor");
  scene.SetBackground({0.05, 0.05, 0.08});
  return scene;
}

nacre::RenderSettings Small() { return {.width = 40, .height = 30, .samples = 2}; }

// The error that body() throws.
template <class Body>
nacre::Error ErrorOf(const Body& body) {
  try {
    body();
  } catch (const nacre::Error& error) {
    return error;
  }
  FAIL("nothing was thrown");
  return nacre::Error(0, {}, "");
}

TEST_CASE("a scene built in code is that of the file, to the bit") {
  const nacre::Image built = nacre::Render(BuildFirstScene(), Small());
  const nacre::Image loaded = nacre::Render(nacre::Scene::FromFile(kFirstScene), Small());
  REQUIRE(built.channels.size() == 4);
  for (const nacre::Channel& channel : built.channels) {
    CAPTURE(channel.name);
    REQUIRE((channel.samples == loaded.Find(channel.name)->samples));
  }
}

TEST_CASE("shapes given as parameters, as text and directly are the same") {
  nacre::Scene direct = BuildFirstScene();
  direct.AddSphere({1, 0.5, 2}, 0.25, "red");
  nacre::Scene parameters = nacre::Scene::FromFile(kFirstScene);
  parameters.AddShape(
      {{"type", "sphere"}, {"center", {1, 0.5, 2}}, {"radius", 0.25}, {"material", "red"}});
  REQUIRE(parameters.sphere_count() == 3);
  const nacre::Image a = nacre::Render(direct, Small());
  const nacre::Image b = nacre::Render(parameters, Small());
  REQUIRE((a.Find("R")->samples == b.Find("R")->samples));
  REQUIRE((a.Find("R")->samples != nacre::Render(BuildFirstScene(), Small()).Find("R")->samples));
}

TEST_CASE("what is set is seen, and copies are independent") {
  const nacre::Scene before = nacre::Scene::FromFile(kFirstScene);
  nacre::Scene after = before;
  after.Set("/materials/red/base_color", {0, 0, 1});
  const auto red = [](const nacre::Scene& scene) {
    return nacre::Render(scene, Small()).Find("R")->samples;
  };
  REQUIRE((red(before) == red(nacre::Scene::FromFile(kFirstScene))));
  REQUIRE((red(before) != red(after)));
  REQUIRE(before.material_names() == std::vector<std::string>{"red", "floor"});
  REQUIRE(before.light_names() == std::vector<std::string>{"key", "sky"});
}

TEST_CASE("values are read where they were set, and where the file has them") {
  nacre::Scene scene = nacre::Scene::FromFile(NACRE_SOURCE_DIR "/scenes/first_scene.json");
  const auto at = [&](const auto& of, const char* pointer) {
    const std::optional<nacre::Value> value = of.Get(pointer);
    return value ? value->json() : std::string("nothing");
  };
  CHECK(at(scene, "/materials/red/roughness") == "0.3");
  CHECK(at(scene, "/shapes/1/center") == "[0,-1000,0]");
  CHECK(at(scene, "/materials/red/metallic") == "nothing");
  CHECK(at(scene, "/shapes/2") == "nothing");
  CHECK(at(scene, "").find("\"lambert\"") != std::string::npos);
  CHECK(scene.Has("/shapes"));
  CHECK(scene.Has("/shapes/1/center/2"));
  CHECK_FALSE(scene.Has("/shapes/2"));
  CHECK_FALSE(scene.Has("/materials/red/metallic"));
  CHECK_THROWS_AS(scene.Has("materials"), nacre::Error);
  scene.Set("/materials/red/metallic", 0.5);
  CHECK(at(scene, "/materials/red/metallic") == "0.5");
  nacre::Session session(scene);
  CHECK(at(session, "/materials/red/metallic") == "0.5");
  session.Set("/materials/red/metallic", 0.25);
  CHECK(at(session, "/materials/red/metallic") == "0.25");
  CHECK(at(session, "/shapes/0/radius") == "1");
  CHECK_THROWS_AS(scene.Get("materials"), nacre::Error);
  CHECK_THROWS_AS(session.Get("materials"), nacre::Error);
}

TEST_CASE("a place that is not there is refused where it is set, and nothing changes") {
  nacre::Scene scene = nacre::Scene::FromFile(kFirstScene);
  const std::string before = scene.Get("")->json();
  const auto refuses = [&](const char* pointer, const char* json) {
    INFO(pointer << " " << json);
    CHECK(ErrorOf([&] { scene.Set(pointer, nacre::Value::Json(json)); }).exit_code() == 64);
    CHECK(scene.Get("")->json() == before);
  };
  refuses("materials", "1");
  refuses("/materials/rad/roughness", "1");
  refuses("/lights/kay/intensity", "1");
  refuses("/textures/t/filter", "1");
  refuses("/shapes/2/radius", "1");
  refuses("/shapes/-", "{}");
  refuses("/background/0/1", "1");
  refuses("/materials/red/roughness", "[");
  refuses("/materials/red/roughness/deeper", "1");
  refuses("/materials/new", "{");
  CHECK_NOTHROW(scene.Check());
  scene.Set("/materials/new/model", "lambert");  // which makes it a material
  CHECK(scene.material_names() == std::vector<std::string>{"red", "floor", "new"});
  scene.Set("/materials", nacre::Value::Json(R"({"floor": {"model": "lambert"}})"));
  CHECK_FALSE(scene.Has("/materials/red"));
  CHECK(scene.Has("/materials/floor/model"));
  CHECK(ErrorOf([&] { scene.Set("/materials/red/roughness", 1); }).exit_code() == 64);
}

TEST_CASE("values of many named entries are put where they belong") {
  nacre::Scene scene;
  for (int i = 0; i < 100; ++i) {
    scene.AddMaterial("m" + std::to_string(i), {{"model", "lambert"}, {"albedo", i}});
  }
  scene.Set("/materials/m70/albedo", 0.5);
  scene.AddMaterial("m99", {{"model", "phong"}});
  scene.Set("/materials/m100", nacre::Value::Json(R"({"model": "burley"})"));
  const auto at = [&](const std::string& pointer) { return scene.Get(pointer)->json(); };
  CHECK(at("/materials/m69/albedo") == "69");
  CHECK(at("/materials/m70") == R"({"model":"lambert","albedo":0.5})");
  CHECK(at("/materials/m99") == R"({"model":"phong"})");
  CHECK(at("/materials/m100/model") == R"("burley")");
  const nacre::Scene copy = scene;
  scene.Set("/materials/m0/albedo", 7);
  CHECK(copy.Get("/materials/m0/albedo")->json() == "0");
}

TEST_CASE("a scene of bytes is the one that they were made of") {
  nacre::Scene scene = nacre::Scene::FromFile(kFirstScene);
  scene.AddSphere({1, 0.5, 2}, 0.25, "red");
  nacre::Mesh mesh;
  mesh.positions = {{-1, 0, 2}, {1, 0, 2}, {0, 1, 2}};
  mesh.normals = {3, {0, 0, 1}};
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
  mesh.triangles = {0, 1, 2};
  scene.AddMesh(mesh, "floor");
  const std::vector<uint8_t> bytes = scene.ToBytes();
  const nacre::Scene again = nacre::Scene::FromBytes(bytes);
  CHECK(again.ToBytes() == bytes);
  nacre::RenderSettings settings = Small();
  settings.layers = {"all"};
  const nacre::Image a = nacre::Render(scene, settings), b = nacre::Render(again, settings);
  REQUIRE(a.channels.size() == b.channels.size());
  for (size_t i = 0; i < a.channels.size(); ++i) {
    CHECK((a.channels[i].samples == b.channels[i].samples));
  }
  for (size_t size = 0; size < bytes.size(); size += 97) {
    const std::vector<uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(size));
    CHECK(ErrorOf([&] { nacre::Scene::FromBytes(cut); }).exit_code() == 65);
  }
  scene.AddMaterial("mine", nacre::UserBrdf{[](const auto&, const auto&) {}, {}, {}});
  CHECK(ErrorOf([&] { scene.ToBytes(); }).faults()[0].what.find("\"mine\" is a function") !=
        std::string::npos);
}

TEST_CASE("meshes are added, and a model is a scene") {
  nacre::Scene scene = BuildFirstScene();
  nacre::Mesh triangle;
  triangle.positions = {{-1, 0, 2}, {1, 0, 2}, {0, 1, 2}};
  triangle.triangles = {0, 1, 2};
  scene.AddMesh(triangle, "red");
  REQUIRE(scene.mesh_count() == 1);
  nacre::RenderSettings settings = Small();
  settings.layers = {"id.object"};
  const nacre::Image image = nacre::Render(scene, settings);
  float largest = 0;
  for (const float id : image.Find("id.object")->samples) largest = std::max(largest, id);
  REQUIRE(largest == 3);  // the mesh, after two spheres

  nacre::Scene model = nacre::Scene::FromFile(NACRE_SOURCE_DIR "/scenes/meshes/torus_knot.obj");
  REQUIRE(model.mesh_count() == 1);
  REQUIRE(ErrorOf([&] { model.AddShape({{"type", "sphere"}}); }).exit_code() == 64);
  REQUIRE_NOTHROW(model.Check());
}

TEST_CASE("errors say where, what and how to mend it") {
  nacre::Scene scene = BuildFirstScene();
  scene.AddMaterial("a/b", {{"model", "lambert"}, {"albedoo", 0.5}});
  scene.AddLight("key", {{"type", "point"}, {"position", {0, 0, 0}}, {"intensity", -1}});
  const nacre::Error error = ErrorOf([&] { nacre::Render(scene); });
  REQUIRE(error.exit_code() == 65);
  REQUIRE(error.faults().size() == 2);
  REQUIRE(error.faults()[0].where == "scene: /materials/a~1b");
  REQUIRE(error.faults()[0].what == "unknown key \"albedoo\"");
  REQUIRE(error.faults()[0].hint == "did you mean \"albedo\"?");
  REQUIRE(error.faults()[1].where == "scene: /lights/key/intensity");
  REQUIRE(std::string(error.what()).find("error: scene: /materials/a~1b: unknown key") == 0);

  nacre::Scene other = BuildFirstScene();
  other.AddSphere({0, 0, 0}, 1, "rd");
  REQUIRE(ErrorOf([&] { other.Check(); }).faults()[0].hint == "did you mean \"red\"?");
  nacre::Scene bad_radius = BuildFirstScene();
  bad_radius.AddSphere({0, 0, 0}, -1, "red");
  REQUIRE(ErrorOf([&] { bad_radius.Check(); }).faults()[0].where == "/spheres/2/radius");
  nacre::Scene twice = BuildFirstScene();
  REQUIRE(ErrorOf([&] {
            twice.AddShape({{"type", "sphere"}, {"type", "mesh"}});
          })
              .faults()[0]
              .where == "AddShape");
  nacre::Scene no_list = BuildFirstScene();
  no_list.Set("/shapes", 5);
  REQUIRE(ErrorOf([&] { no_list.AddShape({{"type", "sphere"}}); }).exit_code() == 64);
  nacre::Mesh pair;
  pair.positions = {{-1, 0, 2}, {1, 0, 2}, {0, 1, 2}};
  pair.triangles = {0, 1, 2, 0, 7, 2};
  nacre::Scene beyond = BuildFirstScene();
  beyond.AddMesh(pair, "red");
  const nacre::Error index = ErrorOf([&] { beyond.Check(); });
  REQUIRE(index.faults()[0].where == "/meshes/0/triangles/1");
  REQUIRE(index.faults()[0].what == "there is no position 7");
  REQUIRE(
      ErrorOf([&] { nacre::Scene::FromFile("model.fbx"); }).faults()[0].what.find("an FBX file") !=
      std::string::npos);
  REQUIRE(ErrorOf([&] { nacre::Scene::FromFile("no such file.json"); }).exit_code() == 65);
  REQUIRE(ErrorOf([&] { nacre::Scene::FromJson("{"); }).exit_code() == 65);
  REQUIRE(ErrorOf([&] { other.Set("/image/spp", std::nan("")); }).exit_code() == 64);
}

TEST_CASE("a scene in text may not name files outside its folder, a scene in code may") {
  const std::string file = NACRE_SOURCE_DIR "/scenes/meshes/torus_knot.obj";
  const nacre::Parameters mesh = {{"type", "mesh"}, {"file", file}, {"material", "red"}};
  nacre::Scene text = nacre::Scene::FromFile(kFirstScene);
  text.AddShape(mesh);
  REQUIRE_NOTHROW(text.Check());  // scenes/meshes is below scenes
  nacre::Scene elsewhere = nacre::Scene::FromJson(R"({"nacre": 1})", NACRE_SOURCE_DIR "/src");
  elsewhere.AddMaterial("red", {{"model", "lambert"}});
  elsewhere.AddShape(mesh);
  REQUIRE(ErrorOf([&] { elsewhere.Check(); }).exit_code() == 65);
  nacre::Scene code = BuildFirstScene();
  code.AddShape(mesh);
  REQUIRE_NOTHROW(code.Check());
}

}  // namespace
