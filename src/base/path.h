// SPDX-License-Identifier: Apache-2.0
// base/path.h: file name extensions.
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>

namespace nacre {

// Whether the path ends in `extension` (".exr", lower case), in whatever case it is written.
inline bool HasExtension(const std::string& path, std::string_view extension) {
  std::string own = std::filesystem::path(path).extension().string();
  std::transform(own.begin(), own.end(), own.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return own == extension;
}

}  // namespace nacre
