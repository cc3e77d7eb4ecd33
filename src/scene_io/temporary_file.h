// SPDX-License-Identifier: Apache-2.0
// scene_io/temporary_file.h: writes bytes to a file for readers that need one.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace nacre {

// A file in the folder for temporary files, deleted with the object. Throws Error (kInternal) if it
// cannot be written.
class TemporaryFile {
 public:
  // `suffix`: the end of the file's name, such as ".png".
  TemporaryFile(std::span<const unsigned char> bytes, const std::string& suffix);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace nacre
