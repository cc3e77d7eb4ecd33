// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_materials.h: the materials of a glTF file as materials of the scene.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"
#include "scene_io/gltf_document.h"

namespace nacre {

// Where an image of the file is: a file of its own, or bytes within.
struct GltfImage {
  std::filesystem::path file;               // resolved; empty: `bytes` hold it
  std::shared_ptr<const std::string> data;  // of the buffer or the data URI
  std::string_view bytes;                   // in `data`: encoded (PNG, JPEG...)
  std::string key;  // the same for images that are one file, or the same bytes of one buffer
};

// Throws Error (kBadInput) for images that are not there, out of bounds, or outside the folder, and
// for malformed data URIs.
GltfImage FindGltfImage(const GltfDocument& document, int image);

// A material for each of the file's, by the same number, with unique names, and after them the one
// of primitives that name none. Their textures and images go to the scene.
std::vector<Material> MakeGltfMaterials(GltfDocument* document, Scene* scene);

}  // namespace nacre
