// SPDX-License-Identifier: Apache-2.0
#include "view/document.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <utility>

#include "base/error.h"
#include "base/path.h"
#include "scene_io/load_scene.h"
#include "scene_io/scene_json.h"
#include "view/mailbox.h"
#include "view/page_parts.h"

namespace nacre {
namespace {

// Limits on the history: steps that can be undone, changes within a step, and bytes in all. A
// change holds the values before and after it, which may be whole scenes.
constexpr size_t kMaxSteps = 500;
constexpr size_t kMaxChanges = 1000;
constexpr size_t kMaxHistoryBytes = size_t{64} << 20;

// If there are more plain spheres, they are not listed in the tree unless a change needs it: there
// are no controls for so many, and the list would take more memory than the scene.
constexpr size_t kMaxTreeSpheres = 1000;

// The deepest existing value on the path of `pointer`: the value itself, or the object in which a
// member is about to be created.
std::string ExistingPart(const Json& root, const std::string& pointer) {
  const Json* value = &root;
  size_t end = 0;
  try {
    while (end < pointer.size()) {
      const size_t next = std::min(pointer.find('/', end + 1), pointer.size());
      const Json::json_pointer step(pointer.substr(end, next - end));
      if (!value->contains(step)) break;
      value = &value->at(step);
      end = next;
    }
  } catch (const Json::exception&) {  // not a pointer: Set will report it
  }
  return pointer.substr(0, end);
}

bool IsImageFile(const std::filesystem::path& path) {
  constexpr std::array kExtensions = {".png", ".jpg",  ".jpeg", ".exr", ".hdr", ".tga",
                                      ".tif", ".tiff", ".ppm",  ".pgm", ".pfm"};
  const std::string name = path.string();
  return std::ranges::any_of(kExtensions, [&](const char* end) { return HasExtension(name, end); });
}

}  // namespace

ViewDocument::ViewDocument(const std::filesystem::path& path, const LoadOptions& options)
    : name_(path.filename().string()),
      path_(path),
      folder_(path.parent_path()),
      live_(path, options),
      original_(live_.root()) {
  if (scene().spheres.size() <= kMaxTreeSpheres) ListShapes();
  if (is_model()) model_original_ = Tree();
}

ViewDocument::ViewDocument(const LoadOptions& options)
    : name_("material ball"),
      folder_(WorkingFolder()),
      live_(ViewFirstScene(), name_, folder_, options),
      original_(live_.root()) {
  ListShapes();
}

void ViewDocument::UseMaterial(size_t index, const Material& material) {
  live_.UseMaterial(index, material);
  SceneChange change = ScenePart::kMaterials;
  change.materials = {static_cast<uint32_t>(index)};
  prepared_.versions.Change(change);
}

void ViewDocument::UseImage(const ImageSettings& image) {
  if (image == live_.scene().image) return;
  live_.UseImage(image);
  prepared_.versions.Change(ScenePart::kImage);
}

// Lists the plain spheres in the tree. Shapes that were not in the tree have not been changed, so
// the original tree gets the same list.
void ViewDocument::ListShapes() {
  if (live_.lists_all_shapes()) return;
  live_.ListShapes();
  original_["shapes"] = live_.root()["shapes"];
}

void ViewDocument::Put(const std::string& pointer, const std::string& json) {
  prepared_.versions.Change(live_.Set(pointer, json));
}

// Applies all changes or none: the values after them in order, or the values before them in
// reverse.
void ViewDocument::PutAll(const std::vector<Change>& changes, bool after) {
  std::vector<const Change*> order;
  for (const Change& change : changes) order.push_back(&change);
  if (!after) std::reverse(order.begin(), order.end());
  size_t done = 0;
  try {
    for (; done < order.size(); ++done) {
      Put(order[done]->pointer, after ? order[done]->after : order[done]->before);
    }
  } catch (...) {
    while (done-- > 0) Put(order[done]->pointer, after ? order[done]->before : order[done]->after);
    throw;
  }
}

void ViewDocument::Set(const std::string& pointer, const Json& value, uint64_t gesture) {
  // It would remove the model's own lights, and setting "/lights" again could not restore them.
  if (pointer == "/lights" && is_model()) {
    throw Error(ExitCode::kUsage, pointer, "a model's lights are set one by one",
                "/lights/NAME is one of them");
  }
  if (pointer.starts_with("/shapes")) ListShapes();  // the history holds the previous value
  std::string place = ExistingPart(live_.root(), pointer);
  // Undoing by a value for all lights of a model would remove its own, so the history keeps the
  // root.
  if (place == "/lights" && place != pointer && is_model()) place.clear();
  if (place.empty()) ListShapes();
  std::string before = JsonText(live_.root().at(Json::json_pointer(place)));
  Put(pointer, JsonText(value));
  std::string after = JsonText(live_.root().at(Json::json_pointer(place)));
  future_.clear();
  Remember({std::move(place), std::move(before), std::move(after)}, gesture);
}

void ViewDocument::Remember(Change change, uint64_t gesture) {
  // Strings that were appended to may have up to twice the capacity that they need.
  change.before.shrink_to_fit();
  change.after.shrink_to_fit();
  const bool same = gesture != 0 && !past_.empty() && past_.back().gesture == gesture &&
                    past_.back().changes.size() < kMaxChanges;
  if (!same) past_.push_back({gesture, {}});
  std::vector<Change>& changes = past_.back().changes;
  // Finds the last change of this place, unless a later change was within it or enclosed it.
  const auto nested = std::find_if(changes.rbegin(), changes.rend(), [&](const Change& other) {
    return PointersOverlap(other.pointer, change.pointer);
  });
  if (nested != changes.rend() && nested->pointer == change.pointer) {
    nested->after = std::move(change.after);
  } else {
    changes.push_back(std::move(change));
  }
  size_t bytes = 0, steps = 0;
  for (auto step = past_.rbegin(); step != past_.rend() && bytes <= kMaxHistoryBytes; ++step) {
    for (const Change& kept : step->changes) {
      bytes += kept.pointer.size() + kept.before.size() + kept.after.size();
    }
    steps += steps == 0 || bytes <= kMaxHistoryBytes ? 1 : 0;
  }
  steps = std::min(steps, kMaxSteps);
  past_.erase(past_.begin(), past_.end() - static_cast<std::ptrdiff_t>(steps));
}

bool ViewDocument::MoveStep(std::vector<Step>* from, std::vector<Step>* to, bool after) {
  if (from->empty()) return false;
  PutAll(from->back().changes, after);
  to->push_back(std::move(from->back()));
  from->pop_back();
  return true;
}

std::vector<Edit> ViewDocument::Edits() const {
  std::vector<Edit> edits = EditsBetween(original_, live_.root());
  if (!is_model()) return edits;
  // Lights are split up: a value for all lights would remove the model's own.
  std::vector<Edit> split;
  for (Edit& edit : edits) {
    if (edit.pointer != "/lights") {
      split.push_back(std::move(edit));
      continue;
    }
    for (const auto& [name, light] : edit.value.items()) {
      split.push_back({(Json::json_pointer("/lights") / name).to_string(), light});
    }
  }
  return split;
}

std::vector<std::string> ViewDocument::Restore(const std::vector<Edit>& edits) {
  std::vector<std::string> refused;
  Step all;  // merges the steps of all edits
  for (const Edit& edit : edits) {
    try {
      Set(edit.pointer, edit.value, 0);
      std::vector<Change>& changes = past_.back().changes;
      std::move(changes.begin(), changes.end(), std::back_inserter(all.changes));
      past_.pop_back();
    } catch (const Error&) {
      refused.push_back(edit.pointer);
    }
  }
  if (!all.changes.empty()) past_.push_back(std::move(all));
  return refused;
}

bool ViewDocument::Reset() {
  if (live_.root() == original_) return false;
  Set("", original_, 0);
  return true;
}

Json ViewDocument::Tree() const {
  Json tree = live_.root();
  if (!lists_all_shapes()) tree.erase("shapes");
  if (!tree.is_object() || !is_model()) return tree;
  AddMaterials(scene(), &tree);
  AddLights(scene(), &tree);
  return tree;
}

Json ViewDocument::OriginalTree() const {
  if (!is_model()) return original_;
  Json tree = model_original_;
  tree["lights"] = OriginalModelLights();
  return tree;
}

bool ViewDocument::is_model() const { return IsModelFile(path_); }

Json ViewDocument::ModelLights() const {
  Json tree = live_.root();
  AddLights(scene(), &tree);
  return tree["lights"];
}

// Lights that have no edits are taken as they are now.
Json ViewDocument::OriginalModelLights() const {
  Json lights = model_original_.value("lights", Json::object());
  const Json own = live_.root().value("lights", Json::object()), now = ModelLights();
  for (const auto& [name, light] : now.items()) {
    if (!own.contains(name)) lights[name] = light;
  }
  return lights;
}

std::vector<std::string> ViewDocument::ImageFiles() const {
  namespace fs = std::filesystem;
  constexpr int kMaxEntries = 2000, kMaxDepth = 2;
  constexpr size_t kMaxFiles = 300;
  std::vector<std::string> files;
  std::error_code error;
  const fs::path folder = folder_.empty() ? "." : folder_;
  const fs::path base = fs::weakly_canonical(folder, error);
  fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied,
                                         error);
  const fs::recursive_directory_iterator end;
  for (int i = 0; !error && entry != end && i < kMaxEntries && files.size() < kMaxFiles; ++i) {
    const fs::path& path = entry->path();
    const bool hidden = path.filename().string().starts_with('.');
    if (hidden || entry.depth() >= kMaxDepth) entry.disable_recursion_pending();
    std::error_code ignored;
    if (!hidden && IsImageFile(path) && entry->is_regular_file(ignored)) {
      const std::string name = path.lexically_relative(folder).generic_string();
      // A link that leads out of the folder would be refused as a file of a scene
      // (ResolveReference).
      const fs::path inside = fs::canonical(path, ignored).lexically_relative(base);
      if (!inside.empty() && *inside.begin() != "..") files.push_back(name);
    }
    entry.increment(error);
  }
  std::sort(files.begin(), files.end());
  return files;
}

// A user who has orbited the camera, and then saves the scene in an editor, wants to see the change
// from the same viewpoint. A member with a new value in the file takes that value, as it is the
// latest.
void ViewDocument::ReadChangedFiles() {
  const Json edited = live_.root();
  prepared_.versions.Change(live_.ReadChangedFiles());
  const Json before = std::exchange(original_, live_.root());
  if (is_model()) model_original_ = Tree();
  if (edited.contains("shapes") || scene().spheres.size() <= kMaxTreeSpheres) ListShapes();
  kept_edits_ = false;
  const auto put_again = [&](const Json::json_pointer& pointer, const Json& value) {
    try {
      Put(pointer.to_string(), JsonText(value));
      kept_edits_ = true;
    } catch (const Error&) {  // it needs something that the file no longer has
    }
  };
  for (const auto& [name, value] : edited.items()) {
    const Json old = before.value(name, Json());
    if (value == old || original_.value(name, Json()) != old) continue;
    const Json::json_pointer pointer = Json::json_pointer() / name;
    if (name != "lights" || !is_model()) {
      put_again(pointer, value);
      continue;
    }
    // One by one: a value for all lights would remove the model's own.
    for (const auto& [light, own] : value.items()) put_again(pointer / light, own);
  }
  if (original_ == before) return;
  past_.clear();
  future_.clear();
}

}  // namespace nacre
