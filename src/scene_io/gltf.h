// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf.h: scenes from glTF 2.0 files.
#pragma once

#include <filesystem>

#include "scene/scene.h"
#include "scene_io/load_scene.h"

namespace nacre {

// Meshes, skins, materials with their textures, lights and the first camera of the default scene of
// a .gltf or .glb file; has_camera says whether there is one. What the file does not say is left to
// CompleteModelScene (model_scene.h). What is in it and not shown is told by options.on_warning.
// Throws Error (kBadInput), with the file and the JSON pointer, for whatever is wrong.
Scene ReadGltf(const std::filesystem::path& path, const LoadOptions& options, bool* has_camera);

}  // namespace nacre
