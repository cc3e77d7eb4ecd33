// SPDX-License-Identifier: Apache-2.0
// base/path.h: file name extensions and absolute paths.
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace nacre {

// Whether the path ends in `extension` (".exr", in lower case), ignoring the path's case.
inline bool HasExtension(const std::string& path, std::string_view extension) {
  std::string own = std::filesystem::path(path).extension().string();
  std::transform(own.begin(), own.end(), own.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return own == extension;
}

// Makes the path absolute. If the working folder no longer exists, returns the path itself, which
// then leads nowhere.
inline std::filesystem::path AbsolutePath(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::path absolute = std::filesystem::absolute(path, error);
  return error ? path : absolute;
}

// The working folder; empty if it no longer exists.
inline std::filesystem::path WorkingFolder() {
  std::error_code ignored;
  return std::filesystem::current_path(ignored);
}

}  // namespace nacre
