// SPDX-License-Identifier: Apache-2.0
#include "scene_io/watched_files.h"

#include <utility>

#include "scene_io/kept_files.h"

namespace nacre {

void WatchedFiles::Add(const std::filesystem::path& file, SceneParts parts) {
  const auto [found, is_new] = files_.try_emplace(file);
  File& known = found->second;
  known.parts |= parts;
  // The key of a known file stays: what was read may be older than the file is now, and updating
  // the key would hide that change.
  if (is_new) known.key = known.present_key = KeyOfFile(file);
}

bool WatchedFiles::Changed(std::chrono::milliseconds rest) {
  const auto now = std::chrono::steady_clock::now();
  bool differs = false;
  for (auto& [path, file] : files_) {
    std::string key = KeyOfFile(path);
    if (key != file.present_key) same_since_ = now;
    file.present_key = std::move(key);
    differs |= file.present_key != file.key;
  }
  if (!differs || now - same_since_ < rest) return false;
  for (auto& [path, file] : files_) {
    file.changed |= file.present_key != file.key;
    file.key = file.present_key;
  }
  return true;
}

SceneParts WatchedFiles::ChangedParts() const {
  SceneParts parts;
  for (const auto& [path, file] : files_) {
    if (file.changed) parts |= file.parts;
  }
  return parts;
}

}  // namespace nacre
