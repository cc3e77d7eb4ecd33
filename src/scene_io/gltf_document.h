// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_document.h: a glTF 2.0 file (.gltf with its buffers, or .glb). The types of all
// members that are read have been checked (gltf_types.h), and the buffers are there; what indices
// and offsets refer to is checked where they are used.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <unordered_set>

#include "base/vec.h"
#include "scene/limits.h"
#include "scene_io/gltf_model.h"
#include "scene_io/load_scene.h"
#include "scene_io/text_file.h"

namespace nacre {

struct GltfDocument {
  Json root;  // the model refers to the extensions in it
  gltf::Model model;
  std::string file;              // what errors call it
  std::filesystem::path folder;  // what its buffers and images are below
  ReferenceRules references;
  uint64_t bytes = 0;  // of the file and its buffers
  std::function<void(const std::string&)> on_warning;
  std::unordered_set<std::string> warned;
  int threads = 0;  // LoadOptions::threads

  // Reports `text` once.
  void Warn(const std::string& text);
  // Throws Error (kBadInput) for the part of the file that the JSON pointer names.
  [[noreturn]] void Refuse(const std::string& pointer, std::string what,
                           std::string hint = {}) const;
  // Refuses data that only the extension of this name, of the object at `pointer`, has.
  [[noreturn]] void RefuseExtension(const std::string& pointer, const std::string& name) const;
  // Refuses the colour, or point, or the number unless it is in the range.
  void Check(const std::string& pointer, const Vec3d& value, const Range& range) const;
  void Check(const std::string& pointer, double value, const Range& range) const;
  // The file that a URI names, which is no data URI; `pointer` says where it is named. Throws Error
  // (kBadInput) for URLs, and as ResolveReference (text_file.h) does.
  std::filesystem::path Resolve(const std::string& uri, const std::string& pointer) const;
};

// Throws Error (kBadInput) for what is not glTF 2.0 or needs a later version, for members of wrong
// types, missing or short buffers, buffers outside the file's folder and extensions that are
// required and not known here.
GltfDocument ReadGltfDocument(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace nacre
