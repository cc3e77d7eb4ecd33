// SPDX-License-Identifier: Apache-2.0
// A scene that was changed step by step is the one that all changes make as overrides.
#include "scene_io/live_scene.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <unistd.h>

#include "base/error.h"
#include "catch.h"
#include "scene/hash.h"
#include "scene_io/load_scene.h"

namespace nacre {
namespace {

const std::filesystem::path kScenes = std::filesystem::path(NACRE_SOURCE_DIR) / "scenes";

struct Change {
  std::string pointer;
  std::string json;
};

// Names and places count as well: layers and shapes go by them.
std::string Describe(const Scene& scene) {
  std::string text = std::to_string(HashScene(scene));
  for (const Material& material : scene.materials) text += " " + material.name;
  for (const Texture& texture : scene.textures) text += " " + texture.name;
  for (const Label& label : scene.labels) text += " " + label.text;
  return text;
}

// Puts random changes, some of which are wrong, and holds each state to a scene that load(options)
// reads anew.
template <class Load>
void CheckChanges(const std::string& file, LiveScene* changed, const Load& load,
                  const std::vector<Change>& changes, int count) {
  LiveScene& live = *changed;
  LoadOptions fresh;
  REQUIRE(Describe(live.scene()) == Describe(load(fresh)));
  std::minstd_rand random(7);
  int refused = 0;
  for (int i = 0; i < count; ++i) {
    const Change& change = changes[random() % changes.size()];
    CAPTURE(file, i, change.pointer, change.json);
    const std::string before = Describe(live.scene());
    fresh.overrides.emplace_back(change.pointer, change.json);
    bool is_right = true;
    try {
      live.Set(change.pointer, change.json);
    } catch (const Error&) {
      is_right = false;
    }
    if (!is_right) {
      ++refused;
      REQUIRE(Describe(live.scene()) == before);
      REQUIRE_THROWS_AS(load(fresh), Error);
      fresh.overrides.pop_back();
      continue;
    }
    REQUIRE(Describe(live.scene()) == Describe(load(fresh)));
  }
  CHECK(refused > 0);
  CHECK(refused < count / 2);
}

void CheckChanges(const std::string& file, const std::vector<Change>& changes, int count) {
  const std::filesystem::path path = kScenes / file;
  LiveScene live(path, {});
  CheckChanges(
      file, &live, [&](const LoadOptions& options) { return LoadScene(path, options); }, changes,
      count);
}

// Named materials, splits, textures, plain spheres in several runs, and shapes of every other kind.
std::string ManyItems() {
  Json scene = {{"nacre", 1}};
  scene["textures"] = {{"waves", {{"file", "textures/waves.png"}, {"mapping", "spherical"}}},
                       {"globe", {{"file", "textures/globe.png"}, {"mapping", "spherical"}}}};
  Json& materials = scene["materials"];
  for (int i = 0; i < 40; ++i) {
    materials["m" + std::to_string(i)] = {{"model", "metallic_roughness"}, {"roughness", 0.02 * i}};
  }
  materials["mapped"] = {{"model", "lambert"}, {"albedo_map", "waves"}};
  materials["split"] = {{"model", "split"}, {"at", {0.5}}, {"materials", {"m1", "m2"}}};
  materials["own_split"] = {
      {"model", "split"}, {"at", {0.5}}, {"materials", {"m1", {{"model", "lambert"}}}}};
  materials["idle"] = {
      {"model", "metallic_roughness"}, {"sheen_color", 0.5}, {"coat_map", "waves"}};
  Json shapes = Json::array();
  const auto add_spheres = [&](int count) {
    for (int i = 0; i < count; ++i) {
      shapes.push_back({{"type", "sphere"},
                        {"center", {0.1 * i, 0.2 * static_cast<double>(shapes.size()), 0}},
                        {"radius", 0.1},
                        {"material", "m" + std::to_string(i % 40)}});
    }
  };
  add_spheres(50);
  shapes.push_back({{"type", "sphere"},
                    {"center", {0, 0, 1}},
                    {"radius", 1},
                    {"material", {{"model", "phong"}, {"shininess", 20}}}});
  shapes.push_back({{"type", "icosphere"},
                    {"center", {0, 0, 2}},
                    {"radius", 1},
                    {"subdivisions", 1},
                    {"material", "m3"}});
  add_spheres(30);
  shapes.push_back(
      {{"type", "grid"},
       {"material", "m5"},
       {"center", {0, 0, 0}},
       {"spacing", 1},
       {"radius", 0.2},
       {"rows", {{"parameter", "roughness"}, {"from", 0}, {"to", 1}, {"count", 2}}},
       {"columns", {{"parameter", "metallic"}, {"from", 0}, {"to", 1}, {"count", 3}}}});
  shapes.push_back(
      {{"type", "sphere"},
       {"center", {0, 3, 1}},
       {"radius", 1},
       {"material",
        {{"model", "split"}, {"at", {0.25}}, {"materials", {"m7", {{"model", "lambert"}}}}}}});
  add_spheres(20);
  scene["shapes"] = std::move(shapes);
  return JsonText(scene);
}

TEST_CASE("Changes of scene files, right and wrong, are those that overrides make",
          "[live_scene]") {
  const std::vector<Change> common = {{"/image/spp", "3"},
                                      {"/image/width", "64"},
                                      {"/image/width", "-1"},
                                      {"/camera/fov_y_deg", "25"},
                                      {"/camera/position", "[0, 1, 9]"},
                                      {"/camera/look_at", "[0, 0.1, 0]"},
                                      {"/camera", "[]"},
                                      {"/background", "[0.1, 0.2, 0.3]"},
                                      {"/background", "0"},
                                      {"/nonsense", "0"},
                                      {"/lights/extra", R"({"type": "directional",
                                       "direction_of_travel": [1, -1, 0], "irradiance": 2})"},
                                      {"/lights/extra/irradiance", "[1, 0, 2]"},
                                      {"/lights/extra/irradiance", "-1"}};
  const auto with = [&](std::vector<Change> more) {
    more.insert(more.end(), common.begin(), common.end());
    return more;
  };
  const std::string extra = R"({"model": "phong", "color": [0.1, 0.2, 0.3], "shininess": 20})";
  CheckChanges("first_scene.json",
               with({{"/materials/red/roughness", "0.1"},
                     {"/materials/red/roughness", "0.7"},
                     {"/materials/red/roughness", "7"},
                     {"/materials/red/base_color", "[0, 1, 0]"},
                     {"/materials/read/roughness", "0.1"},
                     {"/materials/extra", extra},
                     {"/materials/extra/shininess", "40"},
                     {"/materials", R"({"floor": {"model": "lambert"}, "red": )" + extra + "}"},
                     {"/shapes/0/material", "\"floor\""},
                     {"/shapes/0/material", "\"red\""},
                     {"/shapes/0/material", "\"extra\""},
                     {"/shapes/0/material", R"({"model": "lambert", "albedo": 0.25})"},
                     {"/shapes/0/radius", "0.5"},
                     {"/shapes/7/radius", "0.5"},
                     {"/lights/key/intensity", "10"}}),
               250);
  // Materials that shapes make of those of the file.
  CheckChanges("material_grid.json",
               with({{"/shapes/0/material/base_color", "[0.2, 0.3, 0.9]"},
                     {"/shapes/0/radius", "0.3"},
                     {"/shapes/0/radius", "-3"}}),
               60);
  CheckChanges("textures.json",
               with({{"/materials/knot/roughness", "0.9"},
                     {"/materials/knot/base_color_map", "\"globe\""},
                     {"/materials/knot/base_color_map", "\"tiles\""},
                     {"/materials/knot/base_color_map", "\"none\""},
                     {"/materials/floor/normal_map", "null"},
                     {"/materials/floor/normal_map", R"({"texture": "tiles_normal", "scale": 2})"},
                     {"/textures/boxed/scale", "5"},
                     {"/textures/extra", R"({"file": "textures/waves.png"})"},
                     {"/textures/tiles/file", "\"textures/none.png\""},
                     {"/shapes/3/transform/scale", "0.5"},
                     {"/shapes/0/displacement", R"({"texture": "waves", "distance": 0.01,
                       "segments": 16})"}}),
               60);
  CheckChanges("skies.json",
               with({{"/lights/sky/rotate_deg", "30"},
                     {"/lights/sky", R"({"type": "environment", "image": "textures/evening.exr"})"},
                     {"/materials/metal/metallic", "0.5"},
                     {"/shapes/0/columns/to", "0.5"}}),
               40);
  CheckChanges("mesh_lights.json",
               with({{"/lights/knot/radiance", "3"},
                     {"/lights/knot/transform/scale", "0.2"},
                     {"/lights/knot/transform/scale", "0"},
                     {"/lights/die/icosphere/subdivisions", "1"}}),
               60);
}

TEST_CASE("Changes of models are those that overrides make", "[live_scene]") {
  const std::vector<Change> changes = {{"/image/width", "64"},
                                       {"/image/width", "200"},
                                       {"/camera/fov_y_deg", "25"},
                                       {"/camera/position", "[3, 2, 9]"},
                                       {"/background", "0.3"},
                                       {"/background", "-0.3"},
                                       {"/nonsense", "0"},
                                       {"/shapes/0/radius", "1"},
                                       {"/lights/extra", R"({"type": "directional",
                                        "direction_of_travel": [1, -1, 0], "irradiance": 2})"},
                                       {"/lights/extra/irradiance", "-1"},
                                       {"/lights/key/shadows", "false"},
                                       {"/textures/waves", R"({"file": "../textures/waves.png"})"},
                                       {"/materials/none/roughness", "1"}};
  const auto with = [&](std::vector<Change> more) {
    more.insert(more.end(), changes.begin(), changes.end());
    return more;
  };
  CheckChanges("meshes/torus_knot.obj", with({{"/lights", "{}"}}), 60);
  CheckChanges("models/pawns.glb",
               with({{"/materials/brass/sheen_color", "0.5"},
                     {"/materials/brass/sheen_roughness", "0.5"},
                     {"/materials/brass/sheen_roughness", "0"},
                     {"/materials/brass/coat", "0.5"},
                     {"/materials/brass/coat", "0"}}),
               60);
}

TEST_CASE("Changes of one of many items are those that overrides make", "[live_scene]") {
  const std::string text = ManyItems();
  LiveScene live(text, "many", kScenes, {});
  const auto load = [&](const LoadOptions& options) {
    return LoadSceneText(text, "many", kScenes, options);
  };
  const std::vector<Change> changes = {
      {"/materials/m1/roughness", "0.9"},
      {"/materials/m1/roughness", "9"},
      {"/materials/m5/roughness", "0.8"},  // of which a grid makes others
      {"/materials/m9/base_color", "[0.1, 0.2, 0.3]"},
      {"/materials/m9/rougness", "0.1"},
      {"/materials/m9", R"({"model": "phong", "shininess": 40})"},
      {"/materials/m9", R"({"model": "metallic_roughness", "base_color_map": "globe"})"},
      {"/materials/m2/base_color_map", "\"waves\""},
      {"/materials/m2/base_color_map", "\"globe\""},
      {"/materials/m2/base_color_map", "\"none\""},
      {"/materials/m2", R"({"model": "lambert"})"},
      {"/materials/m2/opacity", "0.1"},  // spheres have no holes
      {"/materials/m3/opacity", "0.1"},  // nor has m3, which spheres have
      {"/materials/idle/sheen_roughness", "0.3"},
      {"/materials/idle/sheen_roughness", "0"},
      {"/materials/idle/coat", "0.5"},
      {"/materials/idle/coat", "0"},
      {"/materials/idle/coat_map", "\"globe\""},
      {"/materials/idle/coat_map", "\"waves\""},
      {"/materials/idle/coat_map", "null"},
      {"/materials/idle/roughness", "0.25"},
      {"/materials/m9/sheen_color", "0.5"},
      {"/materials/mapped/albedo", "0.3"},
      {"/materials/mapped/albedo_map", "\"globe\""},
      {"/materials/mapped/albedo_map", "\"waves\""},
      {"/materials/split/at/0", "0.75"},
      {"/materials/split/at/0", "7"},
      {"/materials/split/materials/1", "\"m3\""},
      {"/materials/split/materials/1", "\"own_split\""},
      {"/materials/own_split/materials/1/albedo", "0.125"},
      {"/materials/own_split/at/0", "0.25"},
      {"/materials/own_split/materials/1", "\"m3\""},
      {"/materials/own_split/materials/1", R"({"model": "lambert"})"},
      {"/materials/m8", R"({"model": "split", "at": [], "materials": ["m1"]})"},
      {"/materials/m8", R"({"model": "lambert", "albedo": 0.1})"},
      {"/materials/more", R"({"model": "lambert", "albedo": 0.2})"},
      {"/materials/fewer/albedo", "0.2"},
      {"/shapes/0/radius", "0.3"},
      {"/shapes/7/radius", "0.3"},
      {"/shapes/7/radius", "-0.3"},
      {"/shapes/7/center/1", "0.35"},
      {"/shapes/8/center", "[1, 2, 3]"},
      {"/shapes/49/material", "\"m4\""},
      {"/shapes/49/material", "\"split\""},
      {"/shapes/49/material", "\"m400\""},
      {"/shapes/48/material", R"({"model": "lambert", "albedo": 0.4})"},
      {"/shapes/48/material", "\"m4\""},
      {"/shapes/50/material/shininess", "30"},
      {"/shapes/50/material/shininess", "-30"},
      {"/shapes/50/radius", "0.5"},
      {"/shapes/50/material", R"({"model": "metallic_roughness", "sheen_color": 0.5,
                                  "coat_map": "globe"})"},
      {"/shapes/50/material/coat_map", "\"waves\""},
      {"/shapes/50/material/coat", "0.5"},
      {"/shapes/50/material/sheen_roughness", "0.5"},
      {"/shapes/51/center/2", "4"},
      {"/shapes/51/subdivisions", "2"},
      {"/shapes/51/subdivisions", "1"},
      {"/shapes/52/radius", "0.05"},
      {"/shapes/81/radius", "0.06"},
      {"/shapes/82/rows/count", "3"},
      {"/shapes/82/radius", "0.1"},
      {"/shapes/82/material", "\"idle\""},
      {"/shapes/82/rows/parameter", "\"sheen_roughness\""},
      {"/shapes/82/columns/parameter", "\"coat\""},
      {"/shapes/83/material/at/0", "0.5"},
      {"/shapes/83/material/materials/1/albedo", "0.6"},
      {"/shapes/84", R"({"type": "sphere", "center": [1, 1, 1], "radius": 1, "material": "m1"})"},
      {"/shapes/84", R"({"type": "sphere", "center": [1, 1, 1], "radius": 1, "material": "m1",
                         "displacement": {"texture": "globe", "distance": 0.1, "segments": 8}})"},
      {"/shapes/85/displacement", R"({"texture": "waves", "distance": 0.1, "segments": 8})"},
      {"/shapes/85/displacement/distance", "0.2"},
      {"/shapes/103/radius", "0.07"},
      {"/shapes/104/radius", "0.07"},
      {"/shapes/x/radius", "0.07"},
      {"/textures/globe/scale", "2"},
      {"/image/spp", "3"}};
  CheckChanges("many", &live, load, changes, 1500);
}

TEST_CASE("One of many items is read alone", "[live_scene]") {
  LiveScene live(ManyItems(), "many", kScenes, {});
  const auto listed = [&] { return live.root().at("shapes").size(); };
  const size_t before = listed();
  REQUIRE(before < 10);  // others are numbers
  SceneChange change = live.Set("/materials/m9/roughness", "0.3");
  CHECK(change.parts == SceneParts(ScenePart::kMaterials));
  CHECK(change.materials == std::vector<uint32_t>{9});
  change = live.Set("/materials/split/at/0", "0.3");
  CHECK(change.materials == std::vector<uint32_t>{41});
  // Of a map that shows nothing as well, and where something is shown again.
  CHECK(live.Set("/materials/idle/roughness", "0.3").materials == std::vector<uint32_t>{43});
  CHECK(live.Set("/materials/idle/coat", "0.3").materials == std::vector<uint32_t>{43});
  CHECK(live.Set("/materials/idle/coat", "0").materials == std::vector<uint32_t>{43});
  change = live.Set("/shapes/20/radius", "0.3");
  CHECK(change.parts == SceneParts(ScenePart::kShapes));
  CHECK(change.spheres == std::vector<uint32_t>{20});
  CHECK(listed() == before + 1);
  // Sphere 51 is the next but one: the icosphere between them is a mesh.
  live.Set("/shapes/52/radius", "0.3");
  CHECK(live.scene().spheres[51].radius == 0.3);
  // A material of a shape's own: those of the file come first, and one of a split of theirs.
  change = live.Set("/shapes/50/material/shininess", "30");
  CHECK(change.parts == SceneParts(ScenePart::kMaterials));
  CHECK(change.materials == std::vector<uint32_t>{45});
  change = live.Set("/shapes/82/material", "\"m6\"");
  CHECK(change.materials.size() == 6);
  CHECK_THROWS_AS(live.Set("/materials/m9/roughness", "3"), Error);
  CHECK(live.Set("/materials/m9/roughness", "0.4").parts ==
        (ScenePart::kMaterials | ScenePart::kTextures));  // all of them, after what was wrong
  CHECK(live.Set("/materials/m9/roughness", "0.5").materials == std::vector<uint32_t>{9});
  CHECK(live.Get("/shapes/21/radius") == "0.1");
  CHECK(live.Get("/shapes/20/radius") == "0.3");
  CHECK(live.Get("/shapes/104") == std::nullopt);
  CHECK(listed() < 12);
  live.ListShapes();
  CHECK(listed() == 104);
  live.Set("/shapes/52/radius", "0.4");
  CHECK(live.scene().spheres[51].radius == 0.4);
  LiveScene other(ManyItems(), "many", kScenes, {});
  other.Set("/shapes",
            R"([{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "m1"}])");
  CHECK(other.scene().spheres.size() == 1);
}

TEST_CASE("Pictures of a scene that changes are read once", "[live_scene]") {
  LiveScene live(kScenes / "textures.json", {});
  const auto texels = live.scene().images.front().texels;
  CHECK(live.Set("/materials/knot/roughness", "0.9").parts == SceneParts(ScenePart::kMaterials));
  CHECK(live.scene().images.front().texels == texels);
  CHECK(live.Set("/camera/fov_y_deg", "20").parts == SceneParts(ScenePart::kCamera));
}

TEST_CASE("A grid's materials change without its shapes", "[live_scene]") {
  LiveScene live(kScenes / "material_grid.json", {});
  CHECK_FALSE(live.Set("/shapes/0/material/base_color", "[0, 0, 1]").parts.Has(ScenePart::kShapes));
  CHECK(live.Set("/shapes/0/radius", "0.3").parts.Has(ScenePart::kShapes));
}

// A folder of scene files that are written while they are watched.
struct WatchedFolder {
  WatchedFolder() : path(std::filesystem::temp_directory_path() / "nacre_live_scene_XXXXXX") {
    std::string name = path.string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path = name;
  }
  ~WatchedFolder() { std::filesystem::remove_all(path); }
  WatchedFolder(const WatchedFolder&) = delete;
  WatchedFolder& operator=(const WatchedFolder&) = delete;

  void Write(const char* name, const std::string& text) const {
    std::ofstream(path / name) << text;
  }

  std::filesystem::path path;
};

bool SoonChanged(LiveScene* live) {
  for (int i = 0; i < 500; ++i) {
    if (live->FilesChanged()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

constexpr char kWatchedTriangle[] = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n";

// A scene file with a mesh, and a colour of its material.
std::string WatchedText(const std::string& albedo, const std::string& more = "") {
  return R"({"nacre": 1, "shapes": [{"type": "mesh", "file": "m.obj", "material": "a"}],
             "materials": {"a": {"model": "lambert", "albedo": )" +
         albedo + "}}" + more + "}";
}

TEST_CASE("Of files that have changed only what they make is read again", "[live_scene]") {
  const WatchedFolder folder;
  folder.Write("m.obj", kWatchedTriangle);
  folder.Write("s.json", WatchedText("0.5"));
  LoadOptions options{.overrides = {{"/image/width", "64"}}};
  LiveScene live(folder.path / "s.json", options);
  const auto read_anew = [&] { return Describe(LoadScene(folder.path / "s.json", options)); };
  CHECK_FALSE(live.FilesChanged());
  const Vec3d* const positions = live.scene().meshes[0].positions.data();

  folder.Write("s.json", WatchedText("0.25"));
  REQUIRE(SoonChanged(&live));
  CHECK(live.ReadChangedFiles() == (ScenePart::kMaterials | ScenePart::kTextures));
  CHECK(Describe(live.scene()) == read_anew());
  CHECK(live.scene().meshes[0].positions.data() == positions);

  folder.Write("s.json", WatchedText("0.25", R"(, "background": 1)"));
  REQUIRE(SoonChanged(&live));
  CHECK(live.ReadChangedFiles() == SceneParts(ScenePart::kBackground));
  CHECK(Describe(live.scene()) == read_anew());

  // Written anew, and the same as before.
  folder.Write("m.obj", kWatchedTriangle);
  REQUIRE(SoonChanged(&live));
  CHECK_FALSE(live.ReadChangedFiles().Has(ScenePart::kShapes));
  CHECK(live.scene().meshes[0].positions.data() == positions);

  folder.Write("m.obj", "v -1 -1 0\nv 1 -1 0\nv 0 2 0\nf 1 2 3\n");
  REQUIRE(SoonChanged(&live));
  CHECK(live.ReadChangedFiles().Has(ScenePart::kShapes));
  CHECK(Describe(live.scene()) == read_anew());
  CHECK_FALSE(live.FilesChanged());
}

TEST_CASE("Files that are wrong leave the scene as it was, until they are right", "[live_scene]") {
  const WatchedFolder folder;
  folder.Write("m.obj", kWatchedTriangle);
  folder.Write("s.json", WatchedText("0.5"));
  LiveScene live(folder.path / "s.json", {});
  const std::string before = Describe(live.scene());
  const auto check_wrong = [&] {
    REQUIRE(SoonChanged(&live));
    CHECK_THROWS_AS(live.ReadChangedFiles(), Error);
    CHECK(Describe(live.scene()) == before);
  };
  folder.Write("s.json", "{");
  check_wrong();
  // A change of the mesh is not forgotten because the scene is wrong.
  folder.Write("m.obj", "v -1 -1 0\nv 1 -1 0\nv 0 2 0\nf 1 2 3\n");
  check_wrong();
  // Nor because what it says is, which is found later.
  folder.Write("s.json", WatchedText("7"));
  check_wrong();
  folder.Write("s.json", WatchedText("0.5"));
  REQUIRE(SoonChanged(&live));
  CHECK(live.ReadChangedFiles().Has(ScenePart::kShapes));
  CHECK(live.scene().meshes[0].positions[2].y == 2);
  // A file that is missing is waited for.
  folder.Write("s.json", WatchedText("0.5", R"(, "textures": {"t": {"file": "t.exr"}})"));
  REQUIRE(SoonChanged(&live));
  CHECK_THROWS_AS(live.ReadChangedFiles(), Error);
  std::filesystem::copy_file(kScenes / "textures/evening.exr", folder.path / "t.exr");
  REQUIRE(SoonChanged(&live));
  CHECK(live.ReadChangedFiles().Has(ScenePart::kTextures));
}

TEST_CASE("Models that have changed are read again", "[live_scene]") {
  const WatchedFolder folder;
  folder.Write("m.obj", std::string("mtllib m.mtl\nusemtl a\n") + kWatchedTriangle);
  LiveScene live(folder.path / "m.obj", {});
  folder.Write("m.mtl", "newmtl a\nKd 0 0 1\n");
  REQUIRE(SoonChanged(&live));
  CHECK(live.ReadChangedFiles() == SceneParts::All());
  CHECK(Describe(live.scene()) == Describe(LoadScene(folder.path / "m.obj")));
  folder.Write("m.obj", "f 1 2 3\n");
  REQUIRE(SoonChanged(&live));
  CHECK_THROWS_AS(live.ReadChangedFiles(), Error);
  CHECK(live.scene().meshes.size() == 1);
}

TEST_CASE("Links are followed anew, wherever on the way to a file they are", "[live_scene]") {
  namespace fs = std::filesystem;
  const WatchedFolder folder;
  for (const char* const version : {"v1", "v2"}) fs::create_directories(folder.path / version);
  const auto triangle = [](int top) {
    return "v -1 -1 0\nv 1 -1 0\nv 0 " + std::to_string(top) + " 0\nf 1 2 3\n";
  };
  folder.Write("v1/m.obj", triangle(1));
  folder.Write("v2/m.obj", triangle(2));
  folder.Write("v2/other.obj", triangle(3));
  // As deployments and editors do it: a new link takes the old one's name.
  const auto point = [&](const char* link, const char* target) {
    fs::create_symlink(target, folder.path / "new");
    fs::rename(folder.path / "new", folder.path / link);
  };
  // A link to the file, a folder that is a link, and a link to a link.
  const auto [link, name] = GENERATE(
      table<const char*, const char*>({{"m.obj", "m.obj"}, {"now", "now/m.obj"}, {"a", "b"}}));
  CAPTURE(link, name);
  const bool to_folder = link == std::string("now");
  const auto target = [&](int version) {
    return "v" + std::to_string(version) + (to_folder ? "" : "/m.obj");
  };
  point(link, target(1).c_str());
  if (name == std::string("b")) point("b", "a");
  folder.Write("s.json", R"({"nacre": 1, "materials": {"a": {"model": "lambert"}},
                             "shapes": [{"type": "mesh", "material": "a", "file": ")" +
                             std::string(name) + "\"}]}");
  // The scene, too, is named by a link, of another folder's.
  point("scene.json", "s.json");
  LiveScene live(folder.path / "scene.json", {});
  const auto top = [&] { return live.scene().meshes[0].positions[2].y; };
  const auto check_read = [&](double expected) {
    REQUIRE(SoonChanged(&live));
    CHECK(live.ReadChangedFiles().Has(ScenePart::kShapes));
    CHECK(top() == expected);
    CHECK_FALSE(live.FilesChanged());
  };
  REQUIRE(top() == 1);
  point(link, target(2).c_str());
  check_read(2);
  // What is behind the new target, and no longer what is behind the old one.
  folder.Write("v2/m.obj", triangle(4));
  check_read(4);
  folder.Write("v1/m.obj", triangle(5));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  CHECK_FALSE(live.FilesChanged());
  // A link that leads nowhere, or out of the folder, is waited for.
  for (const char* const nowhere : {"none", "/dev/null"}) {
    point(link, nowhere);
    REQUIRE(SoonChanged(&live));
    CHECK_THROWS_AS(live.ReadChangedFiles(), Error);
    CHECK(top() == 4);
    point(link, target(2).c_str());
    REQUIRE(SoonChanged(&live));
    live.ReadChangedFiles();
    CHECK(top() == 4);
  }
  // A folder that is moved away, and another in its place.
  fs::rename(folder.path / "v2", folder.path / "v0");
  fs::rename(folder.path / "v1", folder.path / "v2");
  check_read(5);
  // Another file of the same size and time of writing, as a second name of it.
  const auto time = fs::last_write_time(folder.path / "v2/m.obj");
  folder.Write("v0/other.obj", triangle(6));
  fs::last_write_time(folder.path / "v0/other.obj", time);
  fs::create_hard_link(folder.path / "v0/other.obj", folder.path / "new.obj");
  fs::rename(folder.path / "new.obj", folder.path / "v2/m.obj");
  check_read(6);
  // Its other name is written to; and the clock may go backwards.
  folder.Write("v0/other.obj", triangle(7));
  fs::last_write_time(folder.path / "v0/other.obj", time - std::chrono::hours(1000));
  check_read(7);
  fs::remove(folder.path / "v2/m.obj");
  folder.Write("v2/m.obj", triangle(8));
  check_read(8);
  // The scene's own link.
  folder.Write("t.json", R"({"nacre": 1, "background": 1})");
  point("scene.json", "t.json");
  REQUIRE(SoonChanged(&live));
  live.ReadChangedFiles();
  CHECK(live.scene().background == Rgb(1));
}

TEST_CASE("Files change once they have come to rest", "[live_scene]") {
  const WatchedFolder folder;
  const std::filesystem::path file = folder.path / "f";
  WatchedFiles files;
  files.Add(file, ScenePart::kLights);
  using std::chrono::milliseconds;
  CHECK_FALSE(files.Changed(milliseconds(0)));
  folder.Write("f", "1");
  CHECK_FALSE(files.Changed(milliseconds(60'000)));
  folder.Write("f", "12");
  CHECK_FALSE(files.Changed(milliseconds(60'000)));
  CHECK(files.ChangedParts().empty());
  CHECK(files.Changed(milliseconds(0)));
  CHECK_FALSE(files.Changed(milliseconds(0)));
  CHECK(files.ChangedParts() == SceneParts(ScenePart::kLights));
  files.ForgetChanges();
  CHECK(files.ChangedParts().empty());
  // Another file of the same name, size and time.
  const auto written = std::filesystem::last_write_time(file);
  folder.Write("g", "34");
  std::filesystem::last_write_time(folder.path / "g", written);
  std::filesystem::rename(folder.path / "g", file);
  CHECK(files.Changed(milliseconds(0)));
  std::filesystem::remove(file);
  CHECK(files.Changed(milliseconds(0)));
}

// The mesh's file is gone: it could not be read again.
TEST_CASE("A material is changed without reading shapes again, which have materials of their own",
          "[live_scene]") {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() /
                                       ("nacre_live_scene_materials_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::filesystem::copy_file(kScenes / "textures" / "tiles.png", folder / "tiles.png",
                             std::filesystem::copy_options::overwrite_existing);
  std::ofstream(folder / "mesh.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                                        "f 1/1 2/2 3/3\n";
  const std::string scene = R"({"nacre": 1, "textures": {"tiles": {"file": "tiles.png"}},
      "materials": {"red": {"model": "lambert"}, "blue": {"model": "lambert"}},
      "shapes": [{"type": "mesh", "file": "mesh.obj",
                  "material": {"model": "lambert", "albedo_map": "tiles"}},
                 {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "blue"}]})";
  std::ofstream(folder / "scene.json") << scene;
  LiveScene live(folder / "scene.json", {});
  LoadOptions fresh;
  const auto whole = [&] { return Describe(LoadScene(folder / "scene.json", fresh)); };
  fresh.overrides.emplace_back("/materials/blue/albedo", "0.25");
  const std::string changed = whole();
  fresh.overrides.emplace_back("/materials/blue/albedo_map", "\"tiles\"");
  const std::string mapped = whole();
  std::filesystem::rename(folder / "mesh.obj", folder / "gone.obj");
  live.Set("/materials/blue/albedo", "0.25");
  CHECK(Describe(live.scene()) == changed);
  // Not so where the shapes' textures move to other places, or change.
  CHECK_THROWS_AS(live.Set("/materials/blue/albedo_map", "\"tiles\""), Error);
  CHECK_THROWS_AS(live.Set("/textures/tiles/scale", "2"), Error);
  CHECK(Describe(live.scene()) == changed);
  std::filesystem::rename(folder / "gone.obj", folder / "mesh.obj");
  live.Set("/materials/blue/albedo_map", "\"tiles\"");
  CHECK(Describe(live.scene()) == mapped);
  std::filesystem::remove_all(folder);
}

TEST_CASE("lights of a model are changed by their members, and removed by null") {
  const std::string path = NACRE_SOURCE_DIR "/scenes/models/pawns.glb";
  const auto light = [](const Scene& scene, const std::string& name) {
    const auto found = std::find_if(scene.lights.begin(), scene.lights.end(),
                                    [&](const Light& l) { return l.name == name; });
    return found == scene.lights.end() ? Light() : *found;
  };
  const Scene plain = LoadScene(path);
  LoadOptions options{.overrides = {{"/lights/key/irradiance", "3"},
                                    {"/lights/fill", "null"},
                                    {"/lights/sky/rotate_deg", "90"}}};
  const Scene loaded = LoadScene(path, options);
  LiveScene live(path, LoadOptions());
  for (const auto& [pointer, json] : options.overrides) live.Set(pointer, json);
  for (const Scene* const scene : {&loaded, &live.scene()}) {
    CHECK(scene->lights.size() == plain.lights.size() - 1);
    CHECK(light(*scene, "fill").name.empty());
    const auto key = std::get<DirectionalLight>(light(*scene, "key").kind);
    CHECK(key.irradiance == Rgb(3));
    CHECK(key.direction_of_travel ==
          std::get<DirectionalLight>(light(plain, "key").kind).direction_of_travel);
    const auto sky = std::get<EnvironmentLight>(light(*scene, "sky").kind);
    CHECK(sky.rotate_deg == 90);
    CHECK(std::holds_alternative<PictureSky>(sky.sky));
  }
  live.Set("/lights/sky/radiance", "2");  // another sky than the room
  CHECK(std::get<ConstantSky>(std::get<EnvironmentLight>(light(live.scene(), "sky").kind).sky)
            .radiance == Rgb(2));
  CHECK(live.Get("/lights/key/irradiance") == "3.0");
  CHECK(live.Get("/lights/fill") == std::nullopt);
}

}  // namespace
}  // namespace nacre
