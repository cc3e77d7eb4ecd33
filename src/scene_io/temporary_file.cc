// SPDX-License-Identifier: Apache-2.0
#include "scene_io/temporary_file.h"

#include <cstdlib>
#include <filesystem>

#include <unistd.h>

#include "base/error.h"

namespace nacre {

TemporaryFile::TemporaryFile(std::span<const unsigned char> bytes, const std::string& suffix)
    : path_((std::filesystem::temp_directory_path() / "nacre-XXXXXX").string() + suffix) {
  const int file = mkstemps(path_.data(), static_cast<int>(suffix.size()));
  bool written = file >= 0;
  while (written && !bytes.empty()) {
    const ssize_t count = write(file, bytes.data(), bytes.size());
    written = count > 0;
    if (written) bytes = bytes.subspan(static_cast<size_t>(count));
  }
  if (file >= 0) close(file);
  if (written) return;
  if (file >= 0) unlink(path_.c_str());
  throw Error(ExitCode::kInternal, path_, "cannot be written",
              "an image inside a model is decoded from there");
}

TemporaryFile::~TemporaryFile() { unlink(path_.c_str()); }

}  // namespace nacre
