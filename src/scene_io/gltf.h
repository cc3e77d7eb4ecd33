// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf.h: scenes from glTF 2.0 files.
#pragma once

#include <filesystem>

#include "scene/scene.h"
#include "scene_io/load_options.h"

namespace nacre {

// Reads the meshes, skins, materials with their textures, lights and first camera of the default
// scene of a .gltf or .glb file. *has_camera is set to whether there is a camera. What the file
// does not specify is left to CompleteModelScene (model_scene.h). Contents that nacre does not show
// are reported to options.on_warning. Throws Error (kBadInput), with the file and the JSON pointer,
// for whatever is wrong.
Scene ReadGltf(const std::filesystem::path& path, const LoadOptions& options, bool* has_camera);

}  // namespace nacre
