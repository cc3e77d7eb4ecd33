// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_materials.h: the materials of a glTF file as materials of the scene.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "scene_io/gltf_document.h"

namespace nacre {

// A material for each of the file's, by the same number, with unique names, and after them the one
// of primitives that name none. Their textures and images go to the scene.
std::vector<Material> MakeGltfMaterials(GltfDocument* document, Scene* scene);

}  // namespace nacre
