// SPDX-License-Identifier: Apache-2.0
// scene_io/read_scene.h: makes a scene of the tree of a scene file, or only the parts that have
// changed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "scene/parts.h"
#include "scene/scene.h"
#include "scene_io/json_text.h"
#include "scene_io/kept_files.h"
#include "scene_io/load_options.h"
#include "scene_io/read_members.h"
#include "scene_io/watched_files.h"

namespace nacre {

// The source of a scene: the arguments of LoadSceneText.
struct SceneSource {
  std::string_view text;
  std::string file;
  std::filesystem::path folder;
};

// The parsed text of a scene file.
struct SceneTree {
  Json root;             // without those elements of "shapes" that are
  PlainSpheres spheres;  // stored here
};

// The run and the number in it of a plain sphere, or the index of another shape in the tree's
// "shapes".
struct ShapePlace {
  std::optional<size_t> run;
  size_t number = 0;
};

// Where shape number `place` of the file is; nullopt if there is none.
std::optional<ShapePlace> FindShape(size_t place, const SceneTree& tree);

// The value at `pointer` as the scene file has it; nullopt if there is none. Plain spheres are not
// moved into the tree. Throws Error (kUsage) if `pointer` is not a JSON pointer.
std::optional<Json> ValueIn(const SceneTree& tree, const std::string& pointer);

// Whether ValueIn would return a value other than null. Large values are not copied.
bool HasValueIn(const SceneTree& tree, const std::string& pointer);

// Moves the plain spheres into the tree if `pointer` points at or into the scene's shapes.
void CompleteTree(const std::string& pointer, SceneTree* tree);

// Parses the text and applies the options' overrides. Throws Error as LoadSceneText does for text
// that is not a scene; lesser errors are added to `faults`.
SceneTree ParseScene(const SceneSource& source, const LoadOptions& options, FaultList* faults);

// Throws Error unless the tree is a scene file of a version that nacre reads.
void CheckVersion(const Json& root, const std::string& file);

struct SceneReading {
  std::filesystem::path folder;  // folder of the scene file
  uint64_t bytes = 0;            // size of its text, to which the size of its images may be in
                                 // proportion
  const LoadOptions* options = nullptr;
  KeptFiles* kept = nullptr;      // cache of files read before; null: none
  WatchedFiles* files = nullptr;  // receives all files that are read; may be null
  // For reading materials without shapes: the scene before, and what was read of it, from which the
  // materials and textures that shapes have brought are taken over. null: not needed.
  const Scene* before = nullptr;
  const ReadMembers* members = nullptr;
};

// Reads the text of a scene file, up to 1 GiB.
std::string ReadSceneText(const std::filesystem::path& path);

// Reads a model as its file has it. *has_camera is set for glTF, the only kind that may have one.
Scene ReadModel(const std::filesystem::path& path, const LoadOptions& options, bool* has_camera);

// Reads these parts, which `scene` must lack, and validates them; the other parts must be there.
// Reading shapes requires reading materials, and reading materials requires reading textures. Adds
// what is wrong to `faults`. Returns nullopt if what was to be taken over from reading.before no
// longer fits: then shapes must be read as well.
std::optional<ReadMembers> ReadScene(const SceneTree& tree, SceneParts parts,
                                     const SceneReading& reading, FaultList* faults, Scene* scene);

// Reads a whole scene file. Throws Error as LoadSceneText does.
Scene ReadSceneSource(const SceneSource& source, const LoadOptions& options);

}  // namespace nacre
