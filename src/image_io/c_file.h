// SPDX-License-Identifier: Apache-2.0
// image_io/c_file.h: a FILE that closes itself, for libraries that read from one.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

namespace nacre {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using CFile = std::unique_ptr<std::FILE, CloseFile>;

// Opens a file for reading. Returns null on failure, with the reason in errno.
inline CFile OpenToRead(const std::string& path) { return CFile(std::fopen(path.c_str(), "rbe")); }

}  // namespace nacre
