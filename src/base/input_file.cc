// SPDX-License-Identifier: Apache-2.0
#include "base/input_file.h"

#include <array>
#include <filesystem>
#include <fstream>

#include "base/error.h"

namespace nacre {

void CheckInputFile(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw Error(ExitCode::kBadInput, path, "no such file");
  if (!std::filesystem::is_regular_file(status)) {
    throw Error(ExitCode::kBadInput, path, "is not a regular file");
  }
  if (std::filesystem::file_size(path, error) == 0) {
    throw Error(ExitCode::kBadInput, path, "cannot be read: it is empty");
  }
  std::array<char, kLfsPointerHead> head{};
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), head.size());
  RefuseLfsPointer(path, {head.data(), static_cast<size_t>(file.gcount())});
}

void RefuseLfsPointer(const std::string& path, std::string_view head) {
  // The specification (git-lfs, Git LFS Specification): this key comes first, and readers
  // of its first version know the older name.
  for (const char* const begin :
       {"version https://git-lfs.github.com/spec/", "version https://hawser.github.com/spec/"}) {
    if (!head.starts_with(begin)) continue;
    throw Error(ExitCode::kBadInput, path, "is a pointer of git-lfs, not the file itself",
                "fetch it: git lfs pull");
  }
}

}  // namespace nacre
