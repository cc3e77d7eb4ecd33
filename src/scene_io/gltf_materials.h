// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_materials.h: the materials of a glTF file as materials of the scene.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "scene_io/gltf_document.h"

namespace nacre {

// Returns a material for each of the file's materials, with the same index and a unique name, and
// after them one more for primitives that name no material. Their textures and images are added to
// the scene.
std::vector<Material> MakeGltfMaterials(GltfDocument* document, Scene* scene);

}  // namespace nacre
