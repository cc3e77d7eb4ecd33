// SPDX-License-Identifier: Apache-2.0
// scene_io/scene_document.h: a scene that is built step by step, as JSON. Setting and getting a
// value takes time that does not depend on the number of earlier values; the values are validated
// only when the document is read as a scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <unordered_map>

#include "scene/scene.h"
#include "scene_io/load_options.h"
#include "scene_io/read_scene.h"

namespace nacre {

// Where the entries of an object are, so that finding one does not need a search of all.
struct EntryPlaces {
  std::unordered_map<std::string, size_t> by_name;
  size_t count = 0;  // the number of entries in the object
};

struct SceneDocument {
  std::filesystem::path model;         // empty: a scene file, or like one
  std::string file = "scene";          // its name in errors
  std::filesystem::path folder = ".";  // where files that it names are looked for
  uint64_t bytes = 0;  // size of the file, to which the size of its images may be in proportion
  SceneTree tree{Json::object({{"nacre", 1}}), {}};  // for a model: what has been set
  bool own_lights = false;                           // for a model: its own lights are replaced
  std::map<std::string, EntryPlaces> places{};       // of materials, lights and textures
};

// The document of a model. Throws Error (kBadInput) for models of a kind that nacre does not read.
SceneDocument DocumentOfModel(const std::filesystem::path& path);

// The document of a scene file's text. Throws Error, and adds to `faults`, as ParseScene does.
SceneDocument ParseDocument(const SceneSource& source, FaultList* faults);

// Sets the value at `pointer` to the JSON value `json`, as LoadOptions::overrides does. Throws
// Error (kUsage) where that cannot be done, and then leaves the document unchanged.
void PutValue(const std::string& pointer, const std::string& json, SceneDocument* document);

// Appends a shape, a JSON object. Throws Error as PutValue does.
void PutShape(const std::string& json, SceneDocument* document);

// Reads the document as a scene and validates it. `faults` may hold errors that were found when the
// document was parsed. The options' overrides and environment are ignored. Throws Error as
// LoadScene does.
Scene ReadDocument(const SceneDocument& document, const LoadOptions& options, FaultList* faults);

}  // namespace nacre
