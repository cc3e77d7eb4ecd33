// SPDX-License-Identifier: Apache-2.0
// scene_io/temporary_file.h: bytes in a file for a reader that wants one.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace nacre {

// A file of its own in the folder for such files, gone with the object. Throws Error (kInternal)
// where it cannot be written.
class TemporaryFile {
 public:
  // `suffix`: of the name, ".png".
  TemporaryFile(std::span<const unsigned char> bytes, const std::string& suffix);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace nacre
