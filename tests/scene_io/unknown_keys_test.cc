// SPDX-License-Identifier: Apache-2.0
// tests/scene_io/unknown_keys_test.cc: a key that nobody reads is a fault, wherever it stands.
#include <functional>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "catch.h"
#include "scene_io/load_scene.h"

namespace nacre {
namespace {

using Json = nlohmann::json;

// Every kind of object that a scene file can hold, but meshes' transforms, which need a file.
constexpr const char* kScene = R"({
  "nacre": 1,
  "camera": {"type": "orthographic", "height": 2},
  "image": {"width": 8, "height": 8, "filter": {"type": "gaussian", "width": 3}},
  "textures": {
    "tiles": {"file": "textures/tiles_normal.png", "mapping": {"kind": "planar"}},
    "waves": {"file": "textures/waves.png"}
  },
  "materials": {
    "lambert": {"model": "lambert", "normal_map": {"texture": "tiles"},
                "bump_map": {"texture": "waves"}}, "phong": {"model": "phong"},
    "pbr": {"model": "metallic_roughness"}, "metal": {"model": "conductor"},
    "glass": {"model": "dielectric"},
    "split": {"model": "split", "at": [0.5], "materials": ["lambert", "phong"]}
  },
  "lights": {
    "sky": {"type": "ambient", "radiance": 1},
    "lamp": {"type": "mesh", "radiance": 1, "icosphere": {"center": [0, 0, 0], "radius": 1}},
    "globe": {"type": "mesh", "radiance": 1, "uv_sphere": {"center": [0, 0, 0], "radius": 1}},
    "sun": {"type": "directional", "direction_of_travel": [0, -1, 0], "irradiance": 1},
    "point": {"type": "point", "position": [0, 9, 0], "intensity": 1,
              "attenuation": {"constant": 1}},
    "spot": {"type": "spot", "position": [0, 9, 0], "direction_of_travel": [0, -1, 0],
             "intensity": 1}
  },
  "shapes": [
    {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": {"model": "lambert"}},
    {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "pbr",
     "displacement": {"texture": "waves", "segments": 8}},
    {"type": "grid", "material": "pbr",
     "rows": {"parameter": "roughness", "from": 0.1, "to": 0.9, "count": 2},
     "columns": {"parameter": "metallic", "values": [0, 1]}},
    {"type": "pair", "a": {"material": "phong", "parameter": "shininess", "values": [8, 16]},
     "b": {"material": "pbr", "count": 2}},
    {"type": "cloud", "count": 3, "min": [0, 0, 0], "max": [1, 1, 1], "radius": 0.1,
     "materials": ["pbr"]},
    {"type": "icosphere", "center": [0, 0, 0], "radius": 1, "material": "pbr"},
    {"type": "uv_sphere", "center": [0, 0, 0], "radius": 1, "material": "pbr"}
  ]
})";

// The message of the faults, or nothing.
std::string Message(const Json& scene) {
  try {
    LoadSceneText(scene.dump(), "a.json", NACRE_SOURCE_DIR "/scenes", {});
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

// Calls body(pointer) for every object below `json`, itself included.
void ForEachObject(const Json& json, const Json::json_pointer& place,
                   const std::function<void(const Json::json_pointer&)>& body) {
  if (json.is_object()) body(place);
  for (const auto& [key, member] : json.items()) {
    if (!member.is_structured()) continue;
    ForEachObject(member, json.is_array() ? place / std::stoul(key) : place / key, body);
  }
}

TEST_CASE("an unknown key is refused in every object") {
  const Json scene = Json::parse(kScene);
  REQUIRE(Message(scene).empty());
  int objects = 0;
  ForEachObject(scene, Json::json_pointer(), [&](const Json::json_pointer& place) {
    const std::string text = place.to_string();
    if (text == "/materials" || text == "/lights" || text == "/textures")
      return;  // their keys are names
    ++objects;
    CAPTURE(text);
    Json changed = scene;
    changed[place]["qqqqqqqq"] = 1;
    CHECK(Message(changed).find("unknown key \"qqqqqqqq\"") != std::string::npos);
  });
  CHECK(objects == 37);
}

}  // namespace
}  // namespace nacre
