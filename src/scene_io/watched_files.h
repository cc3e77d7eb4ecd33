// SPDX-License-Identifier: Apache-2.0
// scene_io/watched_files.h: notices changes of the files that a scene was read from.
//
// Files are polled instead of watched by the system (inotify): polling works on every file system,
// for files that do not exist yet, and for files that are replaced by renaming, as editors do.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <string>

#include "scene/parts.h"

namespace nacre {

class WatchedFiles {
 public:
  // To be called before a file is read, with the parts of the scene that are made from it. A
  // missing file is watched, too.
  void Add(const std::filesystem::path& file, SceneParts parts);

  // Whether a file has changed since it was added, or since the last call that returned true, and
  // no file has changed for `rest`: a file that is still being written is incomplete. To be called
  // several times a second.
  bool Changed(std::chrono::milliseconds rest = std::chrono::milliseconds(100));

  // The parts made from files for which Changed() has returned true since the last ForgetChanges.
  SceneParts ChangedParts() const;
  void ForgetChanges() {
    for (auto& [path, file] : files_) file.changed = false;
  }

 private:
  struct File {
    SceneParts parts;
    std::string key;          // KeyOfFile() when it was added, or when its last change was reported
    std::string present_key;  // KeyOfFile() at the last look
    bool changed = false;
  };
  std::map<std::filesystem::path, File> files_;
  std::chrono::steady_clock::time_point same_since_;
};

}  // namespace nacre
