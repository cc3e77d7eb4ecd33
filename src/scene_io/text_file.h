// SPDX-License-Identifier: Apache-2.0
// scene_io/text_file.h: whole text files, and the files that a scene may refer to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace nacre {

// The bytes of a file. Throws Error (kBadInput) if it is missing, a folder, unreadable or longer
// than max_bytes.
std::string ReadTextFile(const std::filesystem::path& path, uint64_t max_bytes);

// What a scene's references to other files may be, and who is told of them.
struct ReferenceRules {
  bool allow_paths = false;                                     // outside the scene's folder, too
  std::function<void(const std::filesystem::path&)> on_file{};  // each file, before it is read
  std::vector<std::filesystem::path> trusted{};  // files that may lie anywhere; without links
};

// The file that a scene in `folder` refers to as `name`. Throws Error (kBadInput, without a place)
// unless it is a regular file and, links followed, lies below the folder or paths are allowed: a
// scene from elsewhere should not read other files of its user.
std::filesystem::path ResolveReference(const std::filesystem::path& folder, const std::string& name,
                                       const ReferenceRules& rules);

}  // namespace nacre
