// SPDX-License-Identifier: Apache-2.0
// view/document.h: the scene that pages edit, with its history. For one thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "render/prepared_scene.h"
#include "scene_io/live_scene.h"
#include "scene_io/model_tree.h"
#include "view/edits.h"

namespace nacre {

class ViewDocument {
 public:
  // A scene file or a model. Throws Error as LoadScene does.
  ViewDocument(const std::filesystem::path& path, const LoadOptions& options);
  // What is shown without a scene: two spheres, Phong and physically based, beside a grid.
  explicit ViewDocument(const LoadOptions& options);
  ViewDocument(const ViewDocument&) = delete;  // the scene's reader tells it which files it reads
  ViewDocument& operator=(const ViewDocument&) = delete;

  const Scene& scene() const { return live_.scene(); }
  const ImageSettings& own_image() const { return live_.own_image(); }
  PreparedScene* prepared() { return &prepared_; }

  // Renders it with these settings, as LiveScene::UseImage.
  void UseImage(const ImageSettings& image);
  // The same of a material, until another is used or materials change.
  void UseMaterial(size_t index, const Material& material);

  // As LiveScene::Set, and kept in the history: changes of one gesture are one step of it. Gesture
  // 0 is never the same as another. Throws Error: the scene is then the one before.
  void Set(const std::string& pointer, const Json& value, uint64_t gesture);

  // What has been changed of the scene as it was read.
  std::vector<Edit> Edits() const;
  // Makes edits of an earlier document again, as one step. Returns the pointers of those that the
  // scene refuses.
  std::vector<std::string> Restore(const std::vector<Edit>& edits);

  // Each returns whether there was anything to do. What throws Error has changed nothing.
  bool Undo();
  bool Redo();
  bool Reset();  // to the scene as it was read; a step of the history

  bool can_undo() const { return !past_.empty(); }
  bool can_redo() const { return !future_.empty(); }
  // Edits that have outlived a change of the file are no step that could be undone.
  bool can_reset() const { return can_undo() || kept_edits_; }

  // The file's tree with all changes. A model's has materials and lights of the file in it. Without
  // "shapes" if these are too many to be listed.
  Json Tree() const;
  bool lists_all_shapes() const { return live_.lists_all_shapes(); }
  // The same without the changes.
  Json OriginalTree() const;
  bool is_model() const;
  // Of a model: "lights" of both trees. Those that nacre lights models by follow the camera.
  Json ModelLights() const;
  Json OriginalModelLights() const;
  // The camera that is rendered with, every member of it.
  Json Camera() const { return CameraJson(scene().camera); }
  const std::string& name() const { return name_; }
  // Image files of the scene's folder and of folders in it, as scenes name them: not all of very
  // many.
  std::vector<std::string> ImageFiles() const;

  // As LiveScene::FilesChanged; and reads what has changed. Edits stay, but for members
  // (/materials, /camera) that the file has new values for; their history ends where the file has
  // changed. Throws Error: the document is then the one before.
  bool FilesChanged() { return live_.FilesChanged(); }
  void ReadChangedFiles();

 private:
  // Values are kept as text, which takes a tenth of a tree's memory.
  struct Change {
    std::string pointer, before, after;
  };
  struct Step {
    uint64_t gesture = 0;
    std::vector<Change> changes;
  };

  void Put(const std::string& pointer, const std::string& json);
  void PutAll(const std::vector<Change>& changes, bool after);
  void Remember(Change change, uint64_t gesture);
  void ListShapes();

  std::string name_;
  std::filesystem::path path_;  // empty: the built-in scene
  std::filesystem::path folder_;
  LiveScene live_;
  PreparedScene prepared_;
  Json original_;        // as read: of a model, what it was given besides
  Json model_original_;  // of a model: Tree() as read
  std::vector<Step> past_, future_;
  bool kept_edits_ = false;
};

}  // namespace nacre
