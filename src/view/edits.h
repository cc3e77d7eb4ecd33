// SPDX-License-Identifier: Apache-2.0
// view/edits.h: what pages have changed of a scene, as values to set, and the file in which that
// outlives the server.
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

// The edits that make the second tree of the first. An object that has lost a member, or has its
// members in another order, becomes a new value as a whole.
std::vector<Edit> EditsBetween(const Json& before, const Json& after);

// Edits of a scene that an earlier server had when it ended, and, in their place, those of this
// one. The file lies in StateFolder(), named after the scene.
class EditsFile {
 public:
  // `scene`: the path of the scene; empty: the one that is built in. null where nothing can be
  // kept: there is no folder for it, or another server that shows the scene keeps its edits there.
  // `why_not` says so.
  static std::unique_ptr<EditsFile> Open(const std::string& scene, std::string* why_not);
  ~EditsFile();
  EditsFile(const EditsFile&) = delete;
  EditsFile& operator=(const EditsFile&) = delete;

  // The earlier edits, as long as nobody has said what becomes of them.
  const std::vector<Edit>& offered() const { return offered_; }
  std::time_t offered_time() const { return offered_time_; }
  void ForgetOffered() { offered_.clear(); }

  // Keeps these, and what is offered still; without any there is no file. Returns whether it could.
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
