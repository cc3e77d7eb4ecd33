// SPDX-License-Identifier: Apache-2.0
// scene_io/text_file.h: whole text files, and the files that a scene may refer to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace nacre {

// The text of a file. Throws Error (kBadInput) if it is missing, not a regular file, unreadable or
// longer than max_bytes, which its size tells before it is read; if it is in UTF-16 or UTF-32; and
// with the line if it has a character 0 in it, after which nothing more is read.
std::string ReadTextFile(const std::filesystem::path& path, uint64_t max_bytes);

// The bytes of a file. `judge`, if any, sees the first 64 KiB, or all of a shorter file, and the
// file's size, before the rest is read; it returns how many bytes to read, or throws. Throws Error
// (kBadInput) if it is missing, not a regular file, unreadable or longer than max_bytes.
std::string ReadBytes(const std::filesystem::path& path, uint64_t max_bytes,
                      const std::function<uint64_t(std::string_view, uint64_t)>& judge = {});

// Throws Error (kBadInput) for text with a character 0 at this place.
[[noreturn]] void RefuseZero(std::string_view text, size_t zero, const std::string& file);

// What a scene's references to other files may be, and who is told of them.
struct ReferenceRules {
  bool allow_paths = false;                                     // outside the scene's folder, too
  std::function<void(const std::filesystem::path&)> on_file{};  // LoadOptions::on_file
  std::vector<std::filesystem::path> trusted{};  // files that may lie anywhere; without links
};

// What ResolveReference says of a file outside the folder, behind its name.
inline constexpr std::string_view kIsOutside = " is outside the scene's folder";

// The file that a scene in `folder` refers to as `name`. Throws Error (kBadInput, without a place)
// unless it is a regular file and, links followed, lies below the folder or paths are allowed: a
// scene from elsewhere should not read other files of its user.
std::filesystem::path ResolveReference(const std::filesystem::path& folder, const std::string& name,
                                       const ReferenceRules& rules);

}  // namespace nacre
