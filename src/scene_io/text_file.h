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

// Reads the text of a file. Throws Error (kBadInput) if it is missing, not a regular file,
// unreadable or larger than max_bytes, which is checked before it is read; if it is in UTF-16 or
// UTF-32; and, with the line, if it contains a character 0, which readers would take for the end.
std::string ReadTextFile(const std::filesystem::path& path, uint64_t max_bytes);

// Reads the bytes of a file. `judge`, if set, gets the first 64 KiB, or all of a shorter file, and
// the file's size, before the rest is read; it returns how many bytes to read, or throws. Throws
// Error (kBadInput) if the file is missing, not a regular file, unreadable or longer than
// max_bytes.
std::string ReadBytes(const std::filesystem::path& path, uint64_t max_bytes,
                      const std::function<uint64_t(std::string_view, uint64_t)>& judge = {});

// Throws Error (kBadInput), with the line, for text with a character 0 at the offset `zero`.
[[noreturn]] void RefuseZero(std::string_view text, size_t zero, const std::string& file);

// Which files a scene may refer to, and a callback that reports them.
struct ReferenceRules {
  bool allow_paths = false;                                     // also outside the scene's folder
  std::function<void(const std::filesystem::path&)> on_file{};  // LoadOptions::on_file
  std::vector<std::filesystem::path> trusted{};  // may lie anywhere; symbolic links resolved
};

// Follows the file's name in ResolveReference's error about a file outside the folder.
inline constexpr std::string_view kIsOutside = " is outside the scene's folder";

// The path of the file that a scene in `folder` refers to as `name`. Throws Error (kBadInput,
// without a location) unless it is a regular file that, with links resolved, lies below the folder
// or that the rules permit: a scene from someone else should not read other files of its user.
std::filesystem::path ResolveReference(const std::filesystem::path& folder, const std::string& name,
                                       const ReferenceRules& rules);

}  // namespace nacre
