// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_document.h: a glTF 2.0 file (.gltf with its buffers, or .glb), parsed by tinygltf.
//
// tinygltf takes the default for what it cannot read and checks no index, so the types of all
// members are checked before it sees them (gltf_types.h), and what they refer to where it is used.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <unordered_set>

#include "scene_io/load_scene.h"
#include "scene_io/text_file.h"
#include "scene_io/tiny_gltf_model.h"

namespace nacre {

struct GltfDocument {
  tinygltf::Model model;
  std::string file;              // what errors call it
  std::filesystem::path folder;  // what its buffers and images are below
  ReferenceRules references;
  std::function<void(const std::string&)> on_warning;
  std::unordered_set<std::string> warned;

  // Tells `text` once.
  void Warn(const std::string& text);
  // Throws Error (kBadInput) for the part of the file that the JSON pointer names.
  [[noreturn]] void Refuse(const std::string& pointer, std::string what,
                           std::string hint = {}) const;
};

// Throws Error (kBadInput) for what is not glTF 2.0, for members of wrong types, missing or short
// buffers, buffers outside the file's folder and extensions that are required and not known here.
GltfDocument ReadGltfDocument(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace nacre
