// SPDX-License-Identifier: Apache-2.0
// scene_io/load_scene.h: scene files, and models as scenes. What scene files may contain is written
// down in scenes/nacre.schema.json, which is what SceneSchema() returns.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/limits.h"
#include "scene/scene.h"
#include "scene/user_brdf.h"

namespace nacre {

// Of a stranger's file: a hundred bytes can ask for a hundred million spheres. A sphere takes about
// 130 bytes until it is rendered, a triangle 150 to 500.
inline constexpr uint64_t kDefaultMaxPrimitives = 20'000'000;

struct LoadOptions {
  // JSON pointer and JSON text of the value to put there before anything is read ("--set"):
  // {"/image/spp", "64"}. Objects on the way are made; places in arrays must exist.
  std::vector<std::pair<std::string, std::string>> overrides;

  // An image of the surroundings that lights the scene in the place of its own lights
  // ("--environment"): the light "environment", of which overrides may change the rest. It is the
  // caller's choice, and may lie anywhere. Empty: none.
  std::filesystem::path environment = {};

  // Reflection models of the caller's own, for the materials of these names.
  UserBrdfs user_brdfs = {};

  // Let the scene refer to files outside its own folder.
  bool allow_paths = false;

  // Files that the caller chose himself, and that may lie anywhere, as `environment` may.
  std::vector<std::filesystem::path> trusted_files = {};

  // Called with each file that the scene refers to, before it is read; for one file perhaps several
  // times. Also with files that are not there. Links stay in the path: where they lead may change.
  std::function<void(const std::filesystem::path&)> on_file = {};

  // To make large shapes on; 0: as many as the machine has.
  int threads = 0;

  // How many spheres and triangles the file may be made into, all shapes and lights together. A
  // sphere with a material of its own, as grids have them, counts as 16. None:
  // kDefaultMaxPrimitives, and of a model no more than its size explains (scene_budget.h).
  std::optional<uint64_t> max_primitives = {};

  // Called now and then with the share of the file that has been read. Throwing from it stops the
  // reading.
  std::function<void(double)> on_progress = {};

  // Called once with each kind of thing that a model file holds and that is not shown as it says.
  std::function<void(const std::string&)> on_warning = {};
};

// True for files that hold a model, by their extension (.gltf, .glb, .obj, .ply), and not a scene
// in JSON.
bool IsModelFile(const std::filesystem::path& path);

// Throws Error (kBadInput) for files that, by their extension, hold a model of a kind that is not
// read (.fbx, .stl, .blend...), with what to do instead.
void RefuseOtherModels(const std::filesystem::path& path);

// Reads a scene file (JSON, up to 1 GiB) or a model, which gets a camera that sees all of it and
// studio lights if it has none. The scene has passed Validate().
// Throws Error: kBadInput with all faults of the file at once (the first 20 in words), each with
// its JSON pointer; kUsage if an override cannot be made.
Scene LoadScene(const std::filesystem::path& path, const LoadOptions& options = {});

// The same for the text of a scene file. `file` is what errors call it; files that it refers to
// are looked for in `folder`.
Scene LoadSceneText(std::string_view text, const std::string& file,
                    const std::filesystem::path& folder, const LoadOptions& options = {});

// The JSON Schema (draft 2020-12) of scene files.
std::string_view SceneSchema();

}  // namespace nacre
