// SPDX-License-Identifier: Apache-2.0
#include "scene_io/kept_files.h"

#include <fmt/format.h>
#include <sys/stat.h>

namespace nacre {

std::string KeyOfFile(const std::filesystem::path& path) {
  struct stat status = {};
  if (stat(path.c_str(), &status) != 0) return path.string() + "|missing";  // its reader reports it
  // The inode and the time of status change are included, because a file that is copied or renamed
  // to this name may have the size and the modification time of the file before.
  const auto time = [](const timespec& t) { return fmt::format("{}.{:09}", t.tv_sec, t.tv_nsec); };
  return fmt::format("{}|{}|{}|{}|{}|{}", path.string(), status.st_dev, status.st_ino,
                     status.st_size, time(status.st_mtim), time(status.st_ctim));
}

void DropUnheld(KeptFiles* kept) {
  std::erase_if(kept->images, [](const auto& entry) { return entry.second.texels.expired(); });
  std::erase_if(kept->skies, [](const auto& entry) { return entry.second.expired(); });
  std::erase_if(kept->light_meshes, [](const auto& entry) { return entry.second.expired(); });
  std::erase_if(kept->measured, [](const auto& entry) { return entry.second.expired(); });
}

}  // namespace nacre
