// SPDX-License-Identifier: Apache-2.0
// view/edits.h: the changes that pages have made to a scene, as values to set, and the file that
// keeps them beyond the server's end.
#pragma once

#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "scene_io/json_text.h"

namespace nacre {

struct Edit {
  std::string pointer;
  Json value;
};

// The edits that turn the first tree into the second. An object that has lost a member, or whose
// members have another order, is set as a whole.
std::vector<Edit> EditsBetween(const Json& before, const Json& after);

// A file with the edits that an earlier server of the scene had when it ended, which are offered to
// the user, and those of this server. It is in StateFolder(), named after the scene.
class EditsFile {
 public:
  // `scene` is the path of the scene; empty: the built-in one. Returns null, with the reason in
  // *why_not, if edits cannot be kept: there is no folder, or another server of the same scene uses
  // the file.
  static std::unique_ptr<EditsFile> Open(const std::string& scene, std::string* why_not);
  ~EditsFile();
  EditsFile(const EditsFile&) = delete;
  EditsFile& operator=(const EditsFile&) = delete;

  // The earlier edits, until the user decides whether to restore or discard them.
  const std::vector<Edit>& offered() const { return offered_; }
  std::time_t offered_time() const { return offered_time_; }
  void ForgetOffered() { offered_.clear(); }

  // Writes these edits, together with those still offered; removes the file if there are none.
  // Returns whether it succeeded.
  bool Keep(std::vector<Edit> edits);

 private:
  EditsFile() = default;
  void ReadOffered();

  std::string scene_, path_;
  int lock_ = -1;
  std::vector<Edit> offered_;
  std::time_t offered_time_ = 0;
};

}  // namespace nacre
