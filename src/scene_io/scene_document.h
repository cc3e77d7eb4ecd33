// SPDX-License-Identifier: Apache-2.0
// scene_io/scene_document.h: what a scene that is built step by step says so far. Values are put
// and read in time that does not depend on how many were put before; only reading it as a scene
// checks them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <unordered_map>

#include "scene/scene.h"
#include "scene_io/load_scene.h"
#include "scene_io/read_scene.h"

namespace nacre {

// Where the entries of an object are, so that one is found without a look at all others.
struct EntryPlaces {
  std::unordered_map<std::string, size_t> by_name;
  size_t count = 0;  // how many entries are in it
};

struct SceneDocument {
  std::filesystem::path model;         // empty: it is a scene file, or like one
  std::string file = "scene";          // what errors call it
  std::filesystem::path folder = ".";  // where files that it names are looked for
  uint64_t bytes = 0;  // of the file, which its images may be large in proportion to
  SceneTree tree{Json::object({{"nacre", 1}}), {}};  // of a model, what has been put
  bool own_lights = false;                           // of a model: it has no others than these
  std::map<std::string, EntryPlaces> places{};       // of materials, lights and textures
};

// That of a model. Throws Error (kBadInput) for models of a kind that is not read.
SceneDocument DocumentOfModel(const std::filesystem::path& path);

// That of the text of a scene file. Throws Error as ParseScene, and adds to `faults` as it does.
SceneDocument ParseDocument(const SceneSource& source, FaultList* faults);

// Puts the value that `json` is JSON for where `pointer` points, as LoadOptions::overrides. Throws
// Error (kUsage) where that cannot be done; the document is then as before.
void PutValue(const std::string& pointer, const std::string& json, SceneDocument* document);

// Adds a shape, an object in JSON, behind all others. Throws Error as PutValue does.
void PutShape(const std::string& json, SceneDocument* document);

// The scene, checked, but for what was found when the document was parsed, which `faults` may have.
// The options' overrides and environment are not looked at. Throws Error as LoadScene does.
Scene ReadDocument(const SceneDocument& document, const LoadOptions& options, FaultList* faults);

}  // namespace nacre
