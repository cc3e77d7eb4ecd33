// SPDX-License-Identifier: Apache-2.0
// scene_io/live_scene.h: a scene that changes while it is open. A change reads again what it
// touches, and the scene is then that of LoadScene with all changes as overrides.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/parts.h"
#include "scene/scene.h"
#include "scene_io/json_text.h"
#include "scene_io/kept_files.h"
#include "scene_io/load_scene.h"
#include "scene_io/model_scene.h"
#include "scene_io/overrides.h"
#include "scene_io/read_item.h"
#include "scene_io/read_scene.h"
#include "scene_io/scene_document.h"
#include "scene_io/watched_files.h"

namespace nacre {

// What a model's file holds, before the camera, lights and overrides that it is given.
struct ModelAsRead {
  Scene scene;  // all but spheres and meshes, which LiveScene has
  bool has_camera = false;
  bool own_lights = false;  // overrides replace all of its lights
};

class LiveScene {
 public:
  // Reads a scene file or a model. Throws as LoadScene does. `complete`, if any, adds shapes that
  // no file holds, whenever shapes have been read; what it throws comes out.
  LiveScene(const std::filesystem::path& path, LoadOptions options,
            std::function<void(Scene*)> complete = {});

  // The text of a scene file, with LoadSceneText's arguments.
  LiveScene(std::string_view text, std::string file, std::filesystem::path folder,
            LoadOptions options, std::function<void(Scene*)> complete = {});

  // A document, whose values and changes are never read again, but the files that it names are. The
  // options' overrides and environment are not looked at.
  LiveScene(SceneDocument document, LoadOptions options, std::function<void(Scene*)> complete = {});

  const Scene& scene() const { return scene_; }

  // Puts the value that `json` is JSON for where `pointer` points, as LoadOptions::overrides, and
  // returns what of the scene may have other values now. A material or a shape is read alone where
  // nothing else depends on what has changed of it. Throws Error as LoadScene does: the scene is
  // then the one before.
  SceneChange Set(const std::string& pointer, const std::string& json);

  // What is read: the tree of a scene file with all changes; of a model, these alone. Plain spheres
  // (SceneTree) are not in it until ListShapes puts them there, half a kilobyte each.
  const Json& root() const { return tree_.root; }
  bool lists_all_shapes() const { return tree_.spheres.runs.empty(); }
  void ListShapes() { nacre::ListShapes(&tree_, &members_); }

  // Whether files that it was read from, those of failed reads included, have changed since: as
  // WatchedFiles::Changed, to be called several times a second.
  bool FilesChanged() { return files_.Changed(); }

  // Reads those files again, and what else of the scene has changed with them. What Set has put is
  // gone. Returns which parts may have other values now. Throws Error as LoadScene does: the scene
  // is then the one before. Only of a scene that was read from a file.
  SceneParts ReadChangedFiles();

  // The same of the files that the scene names, a model's own included, at once: those that are
  // different now. What Set has put stays.
  SceneParts ReadNamedFiles();

  // The value where `pointer` points, as JSON text, in ModelTree of a model; nothing if there is
  // none. Throws Error (kUsage) for what is no pointer.
  std::optional<std::string> Get(const std::string& pointer) const;

  // Whether that is something else than null.
  bool Has(const std::string& pointer) const {
    return model_ ? Get(pointer).value_or("null") != "null" : HasValueIn(tree_, pointer);
  }

  // Renders it with other settings than its own, until the next change of those. Nothing else
  // follows: a model's camera stays.
  void UseImage(const ImageSettings& image) { scene_.image = image; }
  // The same of a material, until materials are read again.
  void UseMaterial(size_t index, const Material& material) {
    scene_.materials[index] = material;
    members_.current = false;  // the next change reads all of them
  }
  const ImageSettings& own_image() const { return own_image_; }

 private:
  void ReadText(std::string_view text);
  void ReadModelFile(ModelOverrides overrides);
  SceneTree Parse(std::string_view text) const;
  LoadOptions Watching();  // options_ of a model that put each file into files_; while this stays
  SceneReading Reading();
  std::optional<SceneChange> ReadItem(const std::string& pointer, std::optional<size_t> shape,
                                      const Replaced& replaced);
  // `material`: of those of the file nothing but this one has changed.
  SceneParts ReadAgain(SceneParts touched, const std::string& material = {});
  SceneParts CompleteModel(SceneParts touched);

  std::filesystem::path path_;  // empty: `file_` is only what errors call the text
  LoadOptions options_;         // without overrides where these are in tree_
  std::vector<std::pair<std::string, std::string>> overrides_;  // of the options
  std::string file_;
  std::filesystem::path folder_;
  uint64_t bytes_ = 0;
  std::function<void(Scene*)> complete_;
  std::optional<ModelAsRead> model_;  // none: a scene file
  SceneTree tree_;                    // of a scene file; of a model, what overrides have put there
  Scene scene_;
  ImageSettings own_image_;              // of the file with its changes
  bool shapes_bring_materials_ = false;  // or textures
  ReadMembers members_;                  // what was read, for reading some of it again
  KeptFiles kept_;
  WatchedFiles files_;
};

}  // namespace nacre
