// SPDX-License-Identifier: Apache-2.0
#include "scene_io/kept_files.h"

#include <system_error>

#include <fmt/format.h>

namespace nacre {

std::string KeyOfFile(const std::filesystem::path& path) {
  std::error_code missing;  // its reader tells of that
  const auto size = std::filesystem::file_size(path, missing);
  const auto written = std::filesystem::last_write_time(path, missing);
  return fmt::format("{}|{}|{}", path.string(), size, written.time_since_epoch().count());
}

void DropUnheld(KeptFiles* kept) {
  std::erase_if(kept->images, [](const auto& entry) { return entry.second.texels.expired(); });
  std::erase_if(kept->skies, [](const auto& entry) { return entry.second.expired(); });
  std::erase_if(kept->light_meshes, [](const auto& entry) { return entry.second.expired(); });
}

}  // namespace nacre
