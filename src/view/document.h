// SPDX-License-Identifier: Apache-2.0
// view/document.h: the scene that pages edit, with its history. Not thread-safe.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "render/prepared_scene.h"
#include "scene_io/live_scene.h"
#include "scene_io/read_keys.h"
#include "view/edits.h"

namespace nacre {

class ViewDocument {
 public:
  // Opens a scene file or a model. Throws Error as LoadScene does.
  ViewDocument(const std::filesystem::path& path, const LoadOptions& options);
  // Opens the built-in scene: two spheres, Phong and physically based, beside a grid.
  explicit ViewDocument(const LoadOptions& options);
  ViewDocument(const ViewDocument&) = delete;  // the scene's reader refers to it
  ViewDocument& operator=(const ViewDocument&) = delete;

  const Scene& scene() const { return live_.scene(); }
  const ImageSettings& own_image() const { return live_.own_image(); }
  PreparedScene* prepared() { return &prepared_; }

  // Replaces the image settings for rendering, as LiveScene::UseImage.
  void UseImage(const ImageSettings& image);
  // Replaces a material for rendering, until another call or a change of materials.
  void UseMaterial(size_t index, const Material& material);

  // Sets a value as LiveScene::Set does, and records it in the history. Consecutive changes of one
  // gesture are a single step; changes of gesture 0 are never merged. Throws Error, and then leaves
  // the scene unchanged.
  void Set(const std::string& pointer, const Json& value, uint64_t gesture);

  // The difference between the scene now and as it was read.
  std::vector<Edit> Edits() const;
  // Applies edits of an earlier document as one step. Returns the pointers of edits that the scene
  // refuses.
  std::vector<std::string> Restore(const std::vector<Edit>& edits);

  // Each returns whether there was anything to do. If they throw Error, nothing has changed.
  bool Undo() { return MoveStep(&past_, &future_, false); }
  bool Redo() { return MoveStep(&future_, &past_, true); }
  bool Reset();  // back to the scene as it was read, as a step of the history

  bool can_undo() const { return !past_.empty(); }
  bool can_redo() const { return !future_.empty(); }
  // Edits that were kept when the file changed are not steps that could be undone.
  bool can_reset() const { return can_undo() || kept_edits_; }

  // The file's tree with all changes; for a model, with the materials and lights of its file.
  // Without "shapes" if there are too many to be listed.
  Json Tree() const;
  bool lists_all_shapes() const { return live_.lists_all_shapes(); }
  // The tree as it was read, without the changes.
  Json OriginalTree() const;
  bool is_model() const;
  // For a model: the "lights" of both trees. The lights that nacre adds to models follow the
  // camera.
  Json ModelLights() const;
  Json OriginalModelLights() const;
  // The camera in use, with all of its members.
  Json Camera() const { return KeysJson(scene().camera); }
  const std::string& name() const { return name_; }
  // Image files in the scene's folder and its subfolders, named as in scenes. Large folders are
  // listed only in part.
  std::vector<std::string> ImageFiles() const;

  // FilesChanged is LiveScene::FilesChanged. ReadChangedFiles reads what has changed. Edits are
  // kept, except in members (/materials, /camera) that have new values in the file; if the file
  // itself has changed, the history is cleared. Throws Error, and then leaves the document
  // unchanged.
  bool FilesChanged() { return live_.FilesChanged(); }
  void ReadChangedFiles();

 private:
  // Values are kept as text, which takes a tenth of the memory of a tree.
  struct Change {
    std::string pointer, before, after;
  };
  struct Step {
    uint64_t gesture = 0;
    std::vector<Change> changes;
  };

  void Put(const std::string& pointer, const std::string& json);
  void PutAll(const std::vector<Change>& changes, bool after);
  // Applies the last step of `from` and moves it. Returns whether there was one.
  bool MoveStep(std::vector<Step>* from, std::vector<Step>* to, bool after);
  void Remember(Change change, uint64_t gesture);
  void ListShapes();

  std::string name_;
  std::filesystem::path path_;  // empty: the built-in scene
  std::filesystem::path folder_;
  LiveScene live_;
  PreparedScene prepared_;
  Json original_;        // as read; for a model, the overrides that it was opened with
  Json model_original_;  // for a model: Tree() as read
  std::vector<Step> past_, future_;
  bool kept_edits_ = false;
};

}  // namespace nacre
