// SPDX-License-Identifier: Apache-2.0
// scene_io/load_scene.h: loads scene files, and models as scenes. The format of scene files is
// specified by scenes/nacre.schema.json, which is what SceneSchema() of schema.h returns.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/scene.h"
#include "scene_io/load_options.h"

namespace nacre {

// True for files that, by their extension (.gltf, .glb, .obj, .ply), hold a model and not a scene
// in JSON.
bool IsModelFile(const std::filesystem::path& path);

// Throws Error (kBadInput), with a hint what to do instead, for files that, by their extension,
// hold a model of a kind that nacre does not read (.fbx, .stl, .blend...).
void RefuseOtherModels(const std::filesystem::path& path);

// Reads a scene file (JSON, up to 1 GiB) or a model, which gets a camera that sees all of it and
// studio lights if it has none. The scene has passed Validate().
// Throws Error: kBadInput with all faults of the file at once (the first 20 in words), each with
// its JSON pointer; kUsage if an override cannot be made.
Scene LoadScene(const std::filesystem::path& path, const LoadOptions& options = {});

// Reads a scene from the text of a scene file, and otherwise behaves as LoadScene. `file` is its
// name in errors; files that it refers to are looked for in `folder`.
Scene LoadSceneText(std::string_view text, const std::string& file,
                    const std::filesystem::path& folder, const LoadOptions& options = {});

// Reads a material from JSON text, an object as in scene files. The material has no name. Throws
// Error as LoadSceneText does, located in `file`.
Material LoadMaterialText(std::string_view json, const std::string& file,
                          const LoadOptions& options = {});

}  // namespace nacre
