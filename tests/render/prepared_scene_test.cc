// SPDX-License-Identifier: Apache-2.0
// Pictures of scenes that change, made with what was kept of the pictures before, have the bits of
// pictures that keep nothing.
#include "render/prepared_scene.h"

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "catch.h"
#include "output/metadata.h"
#include "render/prepared_materials.h"
#include "render/render.h"
#include "scene_io/json_text.h"
#include "scene_io/live_scene.h"

namespace nacre {
namespace {

const std::filesystem::path kScenes = std::filesystem::path(NACRE_SOURCE_DIR) / "scenes";

struct Change {
  std::string pointer;
  std::vector<std::string> values;
};

// What is asked for changes as well.
RenderSettings RandomSettings(std::minstd_rand* random) {
  RenderSettings settings;
  settings.threads = 1 + static_cast<int>((*random)() % 2);
  const auto one_in = [&](unsigned n) { return (*random)() % n == 0; };
  if (one_in(4)) settings.layers = {"all"};
  if (one_in(5)) settings.region = {7, 5, 31, 20};
  if (one_in(6)) settings.intersector = IntersectorChoice::kEmbree;
  if (one_in(6)) settings.intersector = IntersectorChoice::kTiles;
  if (one_in(6)) settings.max_error = 0.2;
  settings.max_samples = 16;
  return settings;
}

// Begins a plan that is given up at one of its steps.
void EndPlan(const Scene& scene, RenderSettings settings, int step, PreparedScene* prepared) {
  settings.on_plan_progress = [&](double) {
    if (step-- == 0) throw Cancelled{};
  };
  try {
    MakePlan(scene, settings, prepared);
  } catch (const Cancelled&) {
    SUCCEED("it is another plan's turn");
  }
}

void CheckChanges(const std::string& file, LiveScene* changed, const std::vector<Change>& changes,
                  int count) {
  LiveScene& live = *changed;
  live.Set("/image/width", "40");
  live.Set("/image/height", "24");
  live.Set("/image/spp", "2");
  PreparedScene prepared;
  std::minstd_rand random(3);
  for (int i = 0; i < count; ++i) {
    const Change& change = changes[random() % changes.size()];
    const std::string& value = change.values[random() % change.values.size()];
    CAPTURE(file, i, change.pointer, value);
    prepared.versions.Change(live.Set(change.pointer, value));
    const RenderSettings settings = RandomSettings(&random);
    if (random() % 4 == 0)
      EndPlan(live.scene(), settings, static_cast<int>(random() % 5), &prepared);
    const FramePlan plan = MakePlan(live.scene(), settings, &prepared);
    const FramePlan anew = MakePlan(live.scene(), settings);
    REQUIRE(plan.why.notes == anew.why.notes);
    REQUIRE(MakeExrHeader(plan, true, {}, &prepared).attributes ==
            MakeExrHeader(anew, true).attributes);
    const Image kept = RenderImage(plan, settings, nullptr);
    const Image fresh = RenderImage(anew, settings, nullptr);
    REQUIRE(kept.channels.size() == fresh.channels.size());
    for (size_t c = 0; c < kept.channels.size(); ++c) {
      CAPTURE(kept.channels[c].name);
      REQUIRE(kept.channels[c].samples == fresh.channels[c].samples);
    }
  }
}

void CheckChanges(const std::string& file, const std::vector<Change>& changes, int count) {
  LiveScene live(kScenes / file, {});
  CheckChanges(file, &live, changes, count);
}

const std::vector<Change> kOfEveryScene = {
    {"/camera/fov_y_deg", {"20", "27", "35"}},
    // The last one is too far away for the trees that are there.
    {"/camera/position",
     {"[0, 1, 9]", "[1, 2, 11]", "[-3, 0.5, 8]", "[-9, 2, -1]", "[0, 40, 120]"}},
    {"/camera/look_at", {"[0, 0.4, 0]", "[0, 0, 0]"}},
    {"/image/width", {"40", "56"}},
    {"/image/spp", {"1", "2", "3"}},
    {"/image/shadows", {"true", "false"}},
    {"/image/filter", {R"({"type": "box"})", R"({"type": "gaussian", "width": 3})"}},
    {"/background", {"0", "[0.1, 0.2, 0.3]"}},
    {"/lights/more",
     {R"({"type": "point", "position": [3, 4, 5], "intensity": 30})",
      R"({"type": "point", "position": [-3, 4, 5], "intensity": 0})",
      R"({"type": "sphere", "center": [-1, 3, 2], "radius": 0.4, "radiance": 9})",
      R"({"type": "rectangle", "center": [0, 4, 2], "facing": [0, -1, 0],
                          "width": 1, "height": 2, "radiance": 5})"}},
    {"/lights/other",
     {R"({"type": "ambient", "radiance": 0.2})",
      R"({"type": "directional", "direction_of_travel": [1, -1, -1],
                           "irradiance": 1, "shadows": false})"}}};

std::vector<Change> With(std::vector<Change> more) {
  more.insert(more.end(), kOfEveryScene.begin(), kOfEveryScene.end());
  return more;
}

TEST_CASE("Pictures of changed scenes have the bits of new ones", "[prepared_scene]") {
  CheckChanges("first_scene.json",
               With({{"/materials/red/roughness", {"0", "0.05", "0.4"}},
                     {"/materials/red/coat", {"0", "1"}},
                     {"/materials/extra", {R"({"model": "phong", "shininess": 30})"}},
                     {"/shapes/0/radius", {"1", "0.7"}},
                     {"/shapes/0/material", {"\"floor\"", "\"red\""}}}),
               150);
  CheckChanges("material_grid.json",
               With({{"/shapes/0/material/base_color", {"[0.2, 0.3, 0.9]", "0.5"}},
                     {"/shapes/0/radius", {"0.3", "0.4"}},
                     {"/shapes/0/rows/count", {"2", "5"}}}),
               80);
  CheckChanges("textures.json",
               With({{"/materials/knot/roughness", {"0.3", "0.9"}},
                     {"/materials/knot/normal_map", {"\"tiles_normal\"", "null"}},
                     {"/materials/knot/opacity", {"1", "0.4"}},
                     {"/materials/knot/sides", {"\"double\"", "\"single\""}},
                     {"/image/culling", {"true", "false"}},
                     {"/textures/boxed/scale", {"5", "1"}},
                     {"/textures/tiles_normal/rotate_deg", {"0", "30"}},
                     {"/shapes/3/transform/scale", {"0.5", "0.9"}}}),
               60);
  CheckChanges("skies.json",
               With({{"/lights/sky",
                      {R"({"type": "environment", "image": "textures/evening.exr"})",
                       R"({"type": "environment", "radiance": 0.5})"}},
                     {"/lights/sky/rotate_deg", {"0", "30"}},
                     {"/materials/metal/metallic", {"0", "1"}}}),
               60);
  CheckChanges("mesh_lights.json",
               With({{"/lights/knot/radiance", {"3", "9"}},
                     {"/lights/knot/visible", {"true", "false"}},
                     {"/lights/die/icosphere/subdivisions", {"0", "1"}},
                     {"/materials/clay/roughness", {"0.1", "0.9"}}}),
               40);
  CheckChanges("models/pawns.glb", kOfEveryScene, 30);
}

TEST_CASE("Pictures of many changed items have the bits of new ones", "[prepared_scene]") {
  Json scene = {
      {"nacre", 1},
      {"camera", {{"position", {0, 0, 9}}, {"look_at", {0, 0, 0}}, {"fov_y_deg", 40}}},
      {"lights", {{"key", {{"type", "point"}, {"position", {3, 5, 4}}, {"intensity", 140}}}}}};
  for (int i = 0; i < 30; ++i) {
    scene["materials"]["m" + std::to_string(i)] = {{"model", "metallic_roughness"},
                                                   {"base_color", {0.03 * i, 0.5, 0.5}}};
  }
  Json shapes = Json::array();
  for (int i = 0; i < 300; ++i) {  // more than occluders are listed of
    shapes.push_back({{"type", "sphere"},
                      {"center", {0.6 * (i % 20) - 5.7, 0.6 * (i / 20) - 4.2, 0.1 * (i % 7)}},
                      {"radius", 0.25},
                      {"material", "m" + std::to_string(i % 30)}});
    if (i % 40 == 7) shapes.back()["material"] = {{"model", "phong"}, {"shininess", 20}};
  }
  scene["shapes"] = std::move(shapes);
  std::vector<Change> changes = With({{"/shapes/7/material/shininess", {"10", "90"}},
                                      {"/shapes/60/radius", {"0.4", "3"}},
                                      {"/shapes/60/center", {"[0, 0, 2]", "[1, 1, 0]"}}});
  for (int i = 0; i < 30; ++i) {
    const std::string material = "/materials/m" + std::to_string(i);
    changes.push_back({material + "/roughness", {"0", "0.2", "0.7"}});
    changes.push_back({material + "/coat", {"0", "1"}});
    if (i % 5 == 0) changes.push_back({material + "/diffuse", {"\"burley\"", "\"lambert\""}});
    if (i % 6 == 0) changes.push_back({material + "/diffuse_coupling", {"\"none\""}});
    if (i % 9 == 0) changes.push_back({material + "/emission", {"0", "[0.1, 0, 0]"}});
    const std::string shape = "/shapes/" + std::to_string(4 * i);
    changes.push_back({shape + "/material", {"\"m2\"", "\"m3\"", "\"m28\""}});
    changes.push_back({shape + "/radius", {"0.2", "0.5"}});
  }
  LiveScene live(JsonText(scene), "many", kScenes, {});
  CheckChanges("many", &live, changes, 400);
}

TEST_CASE("Holes follow their material", "[prepared_scene]") {
  const char* const leaf = R"({"nacre": 1,
    "camera": {"position": [0, 0, 5], "look_at": [0, 0, 0]},
    "lights": {"sky": {"type": "ambient", "radiance": 1}},
    "textures": {"holes": {"file": "textures/tiles.png", "mapping": "spherical",
                           "encoding": "linear"}},
    "materials": {"leaf": {"model": "lambert", "opacity_map": "holes", "opacity_cutoff": 0.3}},
    "shapes": [{"type": "uv_sphere", "center": [0, 0, 0], "radius": 1, "segments": 32,
                "rings": 16, "material": "leaf"}]})";
  LiveScene live(leaf, "leaf", kScenes, {});
  CheckChanges("leaf", &live,
               {{"/materials/leaf/opacity_cutoff", {"0.1", "0.5", "0.9", "2"}},
                {"/materials/leaf/opacity", {"0.5", "1"}},
                {"/materials/leaf/albedo", {"0.5", "1"}},
                {"/materials/leaf/opacity_map", {"null", "\"holes\""}},
                {"/textures/holes/scale", {"1", "3"}}},
               60);
}

TEST_CASE("A material's change makes nothing again but what it is made of", "[prepared_scene]") {
  LiveScene live(kScenes / "mesh_lights.json", {{{"/image/width", "64"}}});
  PreparedScene prepared;
  const auto plan = [&] { return MakePlan(live.scene(), {}, &prepared); };
  const auto change = [&](const char* pointer, const char* value) {
    prepared.versions.Change(live.Set(pointer, value));
  };
  FramePlan before = plan();
  const auto map = before.direct.lights.sampled[0].light.mesh;
  change("/materials/clay/roughness", "0.3");
  FramePlan after = plan();
  CHECK(after.hits.shapes.intersector == before.hits.shapes.intersector);
  change("/materials/clay/opacity_cutoff", "0.75");  // where surfaces are, which trees ask
  after = plan();
  CHECK(after.hits.shapes.intersector != before.hits.shapes.intersector);
  change("/materials/clay/roughness", "0.4");
  CHECK(plan().hits.shapes.intersector == after.hits.shapes.intersector);
  CHECK(after.direct.lights.sampled[0].light.mesh == map);
  change("/lights/knot/radiance", "3");
  after = plan();
  CHECK(after.direct.lights.sampled[0].light.mesh == map);
  change("/camera/fov_y_deg", "30");
  CHECK(plan().hits.shapes.intersector == after.hits.shapes.intersector);
  // Trees stay where the camera moves, but not where it goes far away.
  for (const char* position : {"[0, 2, 12]", "[11, 1, 1]", "[0, 3, -11]"}) {
    change("/camera/position", position);
    CHECK(plan().hits.shapes.intersector == after.hits.shapes.intersector);
  }
  change("/camera/position", "[0, 2, 200]");
  CHECK(plan().hits.shapes.intersector != after.hits.shapes.intersector);
}

TEST_CASE("Tangents stay where the camera moves, and go with their mesh", "[prepared_scene]") {
  LiveScene live(kScenes / "textures.json", {{{"/image/width", "64"}}});
  PreparedScene prepared;
  const auto change = [&](const char* pointer, const char* value) {
    prepared.versions.Change(live.Set(pointer, value));
    return MakePlan(live.scene(), {}, &prepared);
  };
  // On the mesh's own coordinates.
  change("/shapes/3", R"({"type": "uv_sphere", "center": [3.4, 1.2, -0.4], "radius": 1,
                          "segments": 16, "rings": 8, "material": "knot"})");
  change("/textures/tiles_normal/mapping", "\"uv\"");
  const FramePlan mapped = change("/materials/knot/normal_map", "\"tiles_normal\"");
  REQUIRE(mapped.surfaces.textures.tangents.size() == 1);
  const auto tangents = mapped.surfaces.textures.tangents[0];
  const FramePlan moved = change("/camera/position", "[0, 2, 12]");
  CHECK(moved.surfaces.textures.tangents[0] == tangents);
  const FramePlan scaled = change("/shapes/3/radius", "0.5");
  CHECK(scaled.surfaces.textures.tangents[0] != tangents);
}

}  // namespace
}  // namespace nacre
