// SPDX-License-Identifier: Apache-2.0
// base/input_file.h: refuses files that must not be read, whatever their expected contents.
#pragma once

#include <string>
#include <string_view>

namespace nacre {

// Throws Error (kBadInput) unless `path` (with links followed) is a regular file that is not empty.
// Kernel files that claim to be empty (/proc/kmsg) may block forever on reading, as pipes and
// devices do. Also throws for a git-lfs pointer.
void CheckInputFile(const std::string& path);

// Throws Error (kBadInput) if `head`, the beginning of a file, is that of a git-lfs pointer, which
// a clone without git-lfs has in place of the actual file.
void RefuseLfsPointer(const std::string& path, std::string_view head);

// How many bytes of a file RefuseLfsPointer needs.
inline constexpr size_t kLfsPointerHead = 64;

}  // namespace nacre
