// SPDX-License-Identifier: Apache-2.0
// scene_io/read_scene.h: the tree of a scene file made into a scene: all of it, or the parts that
// have changed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "scene/parts.h"
#include "scene/scene.h"
#include "scene_io/json_text.h"
#include "scene_io/kept_files.h"
#include "scene_io/load_scene.h"
#include "scene_io/read_members.h"
#include "scene_io/watched_files.h"

namespace nacre {

// Where a scene comes from: LoadSceneText's arguments.
struct SceneSource {
  std::string_view text;
  std::string file;
  std::filesystem::path folder;
};

// What the text of a scene file says.
struct SceneTree {
  Json root;             // without the elements of "shapes" that are
  PlainSpheres spheres;  // here
};

// The value where `pointer` points, as a scene file has it; nothing if there is none. Plain spheres
// stay where they are. Throws Error (kUsage) for what is no pointer.
std::optional<Json> ValueIn(const SceneTree& tree, const std::string& pointer);

// Whether that is something else than null. Takes no longer for large values.
bool HasValueIn(const SceneTree& tree, const std::string& pointer);

// Moves plain spheres into the tree if `pointer` points at or into the scene's shapes.
void CompleteTree(const std::string& pointer, SceneTree* tree);

// The tree, with the options' overrides made. Throws Error as LoadSceneText does for text that is
// no scene; what is merely wrong in it is added to `faults`.
SceneTree ParseScene(const SceneSource& source, const LoadOptions& options, FaultList* faults);

// Throws Error unless the tree is that of a scene file of a version that is read.
void CheckVersion(const Json& root, const std::string& file);

struct SceneReading {
  std::filesystem::path folder;  // of the scene file
  uint64_t bytes = 0;            // of its text, which its images may be large in proportion to
  const LoadOptions* options = nullptr;
  KeptFiles* kept = nullptr;      // files read before; null: none
  WatchedFiles* files = nullptr;  // gets all that are read; null: nobody asks
  // Where materials are read without shapes: the scene before, and what was read of it, whose
  // shapes' own materials and textures are taken over. null: there are none.
  const Scene* before = nullptr;
  const ReadMembers* members = nullptr;
};

// The text of a scene file, up to 1 GiB.
std::string ReadSceneText(const std::filesystem::path& path);

// A model as its file has it. `has_camera` is set where that may be so, of glTF.
Scene ReadModel(const std::filesystem::path& path, const LoadOptions& options, bool* has_camera);

// Throws Error with what is wrong in these parts of a model's scene.
void ThrowFaultsIn(const Scene& scene, SceneParts parts, const std::string& file);

// Reads these parts, of which `scene` has none, and checks them. The rest of the scene is there.
// Shapes want materials, and materials textures. Adds to `faults` what is wrong. Nothing if what is
// to be taken over does not fit any more: shapes must be read as well.
std::optional<ReadMembers> ReadScene(const SceneTree& tree, SceneParts parts,
                                     const SceneReading& reading, FaultList* faults, Scene* scene);

}  // namespace nacre
