// SPDX-License-Identifier: Apache-2.0
// base/input_file.h: files that must not be read, whatever is expected in them.
#pragma once

#include <string>
#include <string_view>

namespace nacre {

// Throws Error (kBadInput) unless `path` (links followed) is a regular file with bytes in it. Those
// of the kernel that say they have none (/proc/kmsg) may wait for ever when they are read, as pipes
// and devices do. Throws for a git-lfs pointer, too.
void CheckInputFile(const std::string& path);

// Throws Error (kBadInput) if a file that begins so is git-lfs' pointer to another, which a clone
// without git-lfs has in its place.
void RefuseLfsPointer(const std::string& path, std::string_view head);

// As many first bytes as RefuseLfsPointer needs.
inline constexpr size_t kLfsPointerHead = 64;

}  // namespace nacre
