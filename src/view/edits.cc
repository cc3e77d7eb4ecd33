// SPDX-License-Identifier: Apache-2.0
#include "view/edits.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/path.h"
#include "view/private_file.h"

namespace nacre {
namespace {

// A tree takes more than ten times the memory of its text.
constexpr size_t kMaxEditsBytes = size_t{64} << 20;

// FNV-1a, for the name of a scene's file; the file also contains the path itself.
uint64_t HashOfPath(std::string_view text) {
  uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash;
}

// Whether `after` has all members of `before`, in the same order and followed by any new ones, so
// that setting single members turns one into the other.
bool HasMembersOf(const Json& before, const Json& after) {
  if (before.size() > after.size()) return false;
  auto now = after.begin();
  for (auto old = before.begin(); old != before.end(); ++old, ++now) {
    if (old.key() != now.key()) return false;
  }
  return true;
}

void AddEdits(const Json& before, const Json& after, const Json::json_pointer& pointer,
              std::vector<Edit>* edits) {
  const bool objects = before.is_object() && after.is_object() && HasMembersOf(before, after);
  // Points and colours are always set as a whole.
  const bool arrays = before.is_array() && after.is_array() && before.size() == after.size() &&
                      !before.empty() && !before.front().is_number();
  if (!objects && !arrays) {
    if (before != after) edits->push_back({pointer.to_string(), after});
    return;
  }
  auto old = before.begin();
  size_t i = 0;
  for (auto now = after.begin(); now != after.end(); ++now, ++i) {
    const Json::json_pointer place = objects ? pointer / now.key() : pointer / i;
    if (old == before.end()) {
      edits->push_back({place.to_string(), *now});
    } else {
      AddEdits(*old++, *now, place, edits);
    }
  }
}

}  // namespace

std::vector<Edit> EditsBetween(const Json& before, const Json& after) {
  std::vector<Edit> edits;
  AddEdits(before, after, Json::json_pointer(), &edits);
  return edits;
}

std::unique_ptr<EditsFile> EditsFile::Open(const std::string& scene, std::string* why_not) {
  const std::string folder = StateFolder();
  if (folder.empty()) {
    *why_not = "there is no folder of the user's own for them (XDG_STATE_HOME)";
    return nullptr;
  }
  std::unique_ptr<EditsFile> file(new EditsFile);
  std::error_code error;
  if (!scene.empty()) {
    file->scene_ = std::filesystem::weakly_canonical(AbsolutePath(scene), error).string();
  }
  file->path_ = fmt::format("{}/view-{:016x}.json", folder, HashOfPath(file->scene_));
  // The lock is held while the process lives; the system releases it, however that ends.
  const std::string lock = file->path_ + ".lock";
  struct stat opened = {}, named = {};
  do {
    if (file->lock_ >= 0) close(file->lock_);
    file->lock_ = open(lock.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR);
    if (file->lock_ < 0 || fstat(file->lock_, &opened) != 0) {
      *why_not = fmt::format("{} cannot be written", folder);
      return nullptr;
    }
    if (flock(file->lock_, LOCK_EX | LOCK_NB) != 0) {
      *why_not = "another nacre view shows the same scene and keeps its own";
      close(std::exchange(file->lock_, -1));
      return nullptr;
    }
    // The previous holder may have removed the lock file in between.
  } while (stat(lock.c_str(), &named) != 0 || named.st_ino != opened.st_ino);
  file->ReadOffered();
  return file;
}

EditsFile::~EditsFile() {
  if (lock_ < 0) return;
  unlink((path_ + ".lock").c_str());  // while the lock is held
  close(lock_);
}

void EditsFile::ReadOffered() {
  const std::optional<std::string> text = ReadPrivateFile(path_, kMaxEditsBytes);
  const std::optional<Json> json = text ? TryParseJson(*text) : std::nullopt;
  struct stat status = {};
  if (!json || !json->is_object() || stat(path_.c_str(), &status) != 0) return;
  if (json->value("scene", Json()) != scene_) return;
  const Json edits = json->value("edits", Json::array());
  for (const Json& edit : edits) {
    const Json pointer = edit.is_object() ? edit.value("set", Json()) : Json();
    if (pointer.is_string() && edit.contains("value")) {
      offered_.push_back({pointer.get<std::string>(), edit.at("value")});
    }
  }
  offered_time_ = status.st_mtime;
}

bool EditsFile::Keep(std::vector<Edit> edits) {
  edits.insert(edits.begin(), offered_.begin(), offered_.end());
  if (edits.empty()) {
    unlink(path_.c_str());
    return true;
  }
  Json json = {{"nacre_view_edits", 1}, {"scene", scene_}, {"edits", Json::array()}};
  for (Edit& edit : edits) {
    json["edits"].push_back({{"set", std::move(edit.pointer)}, {"value", std::move(edit.value)}});
  }
  const std::string text = JsonText(json) + "\n";
  return text.size() <= kMaxEditsBytes && WritePrivateFile(path_, text);
}

}  // namespace nacre
