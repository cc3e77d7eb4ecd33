// SPDX-License-Identifier: Apache-2.0
#include "view/document.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/path.h"
#include "scene/material_parameters.h"
#include "scene_io/material_json.h"
#include "view/page_parts.h"

namespace nacre {
namespace {

// Steps that can be undone. Each holds the values before and after it, which may be whole scenes.
constexpr size_t kMaxSteps = 500;

// Of more plain spheres no list is made, unless a change needs it: there are no controls for so
// many, and the list would take more memory than the scene.
constexpr size_t kMaxTreeSpheres = 1000;

// The deepest value on the way to where `pointer` points that exists: the pointer itself, or that
// of the object in which a member is going to be made.
std::string ExistingPart(const Json& root, std::string pointer) {
  while (!pointer.empty()) {
    try {
      if (root.contains(Json::json_pointer(pointer))) return pointer;
    } catch (const Json::exception&) {  // no pointer: Set will say so
    }
    const size_t slash = pointer.rfind('/');
    pointer.resize(slash == std::string::npos ? 0 : slash);
  }
  return pointer;
}

Json PointJson(const Vec3d& v) { return {v.x, v.y, v.z}; }

bool IsImageFile(const std::filesystem::path& path) {
  constexpr std::array kExtensions = {".png", ".jpg",  ".jpeg", ".exr", ".hdr", ".tga",
                                      ".tif", ".tiff", ".ppm",  ".pgm", ".pfm"};
  return std::any_of(kExtensions.begin(), kExtensions.end(),
                     [&](const char* extension) { return HasExtension(path.string(), extension); });
}

}  // namespace

ViewDocument::ViewDocument(const std::filesystem::path& path, const LoadOptions& options)
    : name_(path.filename().string()),
      path_(path),
      folder_(path.parent_path()),
      live_(path, options),
      original_(live_.root()) {
  if (scene().spheres.size() <= kMaxTreeSpheres) ListShapes();
}

ViewDocument::ViewDocument(const LoadOptions& options)
    : name_("material ball"),
      folder_(std::filesystem::current_path()),
      live_(ViewFirstScene(), name_, folder_, options),
      original_(live_.root()) {
  ListShapes();
}

void ViewDocument::UseMaterial(size_t index, const Material& material) {
  live_.UseMaterial(index, material);
  prepared_.versions.Change(ScenePart::kMaterials);
}

void ViewDocument::UseImage(const ImageSettings& image) {
  if (image == live_.scene().image) return;
  live_.UseImage(image);
  prepared_.versions.Change(ScenePart::kImage);
}

// Shapes that are not in the tree have not changed either.
void ViewDocument::ListShapes() {
  if (live_.lists_all_shapes()) return;
  live_.ListShapes();
  original_["shapes"] = live_.root()["shapes"];
}

void ViewDocument::Put(const std::string& pointer, const Json& value) {
  prepared_.versions.Change(live_.Set(pointer, JsonText(value)));
}

void ViewDocument::Set(const std::string& pointer, const Json& value, uint64_t gesture) {
  const std::string place = ExistingPart(live_.root(), pointer);
  if (place.empty() || place.starts_with("/shapes")) ListShapes();  // the history holds all of it
  Json before = live_.root().at(Json::json_pointer(place));
  Put(pointer, value);
  Json after = live_.root().at(Json::json_pointer(place));
  future_.clear();
  if (gesture != 0 && !past_.empty() && past_.back().gesture == gesture) {
    std::vector<Change>& changes = past_.back().changes;
    if (!changes.empty() && changes.back().pointer == place) {
      changes.back().after = std::move(after);
      return;
    }
    changes.push_back({place, std::move(before), std::move(after)});
    return;
  }
  past_.push_back({gesture, {{place, std::move(before), std::move(after)}}});
  if (past_.size() > kMaxSteps) past_.erase(past_.begin());
}

bool ViewDocument::Undo() {
  if (past_.empty()) return false;
  Step step = std::move(past_.back());
  past_.pop_back();
  for (auto change = step.changes.rbegin(); change != step.changes.rend(); ++change) {
    Put(change->pointer, change->before);
  }
  future_.push_back(std::move(step));
  return true;
}

bool ViewDocument::Redo() {
  if (future_.empty()) return false;
  Step step = std::move(future_.back());
  future_.pop_back();
  for (const Change& change : step.changes) Put(change.pointer, change.after);
  past_.push_back(std::move(step));
  return true;
}

bool ViewDocument::Reset() {
  if (live_.root() == original_) return false;
  Set("", original_, 0);
  return true;
}

Json ViewDocument::Tree() const {
  Json tree = live_.root();
  if (!lists_all_shapes()) tree.erase("shapes");
  if (!tree.is_object() || !IsModelFile(path_)) return tree;
  Json& materials = tree["materials"];
  for (const Material& material : scene().materials) {
    if (ModelOf(material) == nullptr) continue;
    Json whole = MaterialJson(material);
    if (materials.contains(material.name)) whole.update(materials[material.name]);
    materials[material.name] = std::move(whole);
  }
  return tree;
}

Json ViewDocument::Camera() const {
  const nacre::Camera& camera = scene().camera;
  const bool perspective = camera.projection == Projection::kPerspective;
  Json json = {{"type", perspective ? "perspective" : "orthographic"},
               {"position", PointJson(camera.position)},
               {"look_at", PointJson(camera.look_at)},
               {"up", PointJson(camera.up)}};
  if (perspective) {
    json["fov_y_deg"] = camera.fov_y_deg;
  } else {
    json["height"] = camera.height;
  }
  return json;
}

std::vector<std::string> ViewDocument::ImageFiles() const {
  namespace fs = std::filesystem;
  constexpr int kMaxEntries = 2000, kMaxDepth = 2;
  constexpr size_t kMaxFiles = 300;
  std::vector<std::string> files;
  std::error_code error;
  const fs::path folder = folder_.empty() ? "." : folder_;
  fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied,
                                         error);
  const fs::recursive_directory_iterator end;
  for (int i = 0; !error && entry != end && i < kMaxEntries && files.size() < kMaxFiles; ++i) {
    const fs::path& path = entry->path();
    const bool hidden = path.filename().string().starts_with('.');
    if (hidden || entry.depth() >= kMaxDepth) entry.disable_recursion_pending();
    std::error_code ignored;
    if (!hidden && IsImageFile(path) && entry->is_regular_file(ignored)) {
      files.push_back(path.lexically_relative(folder).generic_string());
    }
    entry.increment(error);
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Whoever has orbited the camera and saves the scene in an editor wants to see the change from
// there. A member that the file has a new value for is the file's: that is what was just written.
void ViewDocument::ReadChangedFiles() {
  const Json edited = live_.root();
  prepared_.versions.Change(live_.ReadChangedFiles());
  const Json before = std::exchange(original_, live_.root());
  if (edited.contains("shapes") || scene().spheres.size() <= kMaxTreeSpheres) ListShapes();
  const auto member = [](const Json& tree, const std::string& name) {
    const auto found = tree.find(name);
    return found != tree.end() ? *found : Json();
  };
  for (const auto& [name, value] : edited.items()) {
    if (value == member(before, name) || member(original_, name) != member(before, name)) continue;
    try {
      Put("/" + name, value);
    } catch (const Error&) {  // it needs what the file no longer has
    }
  }
  if (original_ == before) return;
  past_.clear();
  future_.clear();
}

}  // namespace nacre
