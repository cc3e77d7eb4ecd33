// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_document.h: a glTF 2.0 file (.gltf with its buffers, or .glb). The types of all
// members that are read have been checked (gltf_model.h), and the buffers are loaded; indices and
// offsets are checked where they are used.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/vec.h"
#include "scene/limits.h"
#include "scene_io/gltf_model.h"
#include "scene_io/load_options.h"
#include "scene_io/text_file.h"

namespace nacre {

struct GltfDocument {
  Json root;  // the model points to the extensions in it
  gltf::Model model;
  std::string file;              // the file's name in errors
  std::filesystem::path folder;  // where its buffers and images are looked for
  ReferenceRules references;
  uint64_t bytes = 0;  // size of the file and its buffers together
  std::function<void(const std::string&)> on_warning;
  std::unordered_set<std::string> warned;
  int threads = 0;             // LoadOptions::threads
  std::optional<int> variant;  // of the file's variants, the one to show

  // Reports `text` as a warning, once however often it is called.
  void Warn(const std::string& text) {
    if (warned.insert(text).second && on_warning) on_warning(file + ": " + text);
  }
  // Throws Error (kBadInput), located at `pointer`, a JSON pointer into the file.
  [[noreturn]] void Refuse(const std::string& pointer, std::string what,
                           std::string hint = {}) const;
  // Refuses data that only the extension `name` of the object at `pointer` holds.
  [[noreturn]] void RefuseExtension(const std::string& pointer, const std::string& name) const;
  // The item of an array of the file with this index. If there is none, refuses it, because of
  // `what`, at `pointer`.
  template <class Item>
  const Item& At(const std::vector<Item>& items, int index, const std::string& pointer,
                 std::string what) const {
    const Item* const item = gltf::ItemAt(items, index);
    if (item == nullptr) {
      Refuse(pointer, std::move(what), fmt::format("the file has {}", items.size()));
    }
    return *item;
  }
  // Refuses a colour, point or number that is not within the range.
  void Check(const std::string& pointer, const Vec3d& value, const Range& range) const {
    if (range.Contains(value)) return;
    Refuse(pointer, fmt::format("[{}, {}, {}] is out of range", value.x, value.y, value.z),
           "each number " + Describe(range));
  }
  void Check(const std::string& pointer, double value, const Range& range) const {
    if (range.Contains(value)) return;
    Refuse(pointer, fmt::format("{} is out of range", value), "a number " + Describe(range));
  }
  // The path of the file that a URI names. It must not be a data URI; `pointer` says where the file
  // names it. Throws Error (kBadInput) for URLs, and as ResolveReference (text_file.h) does.
  std::filesystem::path Resolve(const std::string& uri, const std::string& pointer) const;
};

// Throws Error (kBadInput) for files that are not glTF 2.0 or need a later version, members of
// wrong types, missing or short buffers, buffers outside the file's folder and required extensions
// that nacre does not support.
GltfDocument ReadGltfDocument(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace nacre
