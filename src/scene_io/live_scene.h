// SPDX-License-Identifier: Apache-2.0
// scene_io/live_scene.h: a scene that changes while it is open. A change reads again only what it
// affects; the scene is then equal to what LoadScene returns with all changes as overrides.
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
#include "scene_io/load_options.h"
#include "scene_io/model_scene.h"
#include "scene_io/overrides.h"
#include "scene_io/read_item.h"
#include "scene_io/read_scene.h"
#include "scene_io/scene_document.h"
#include "scene_io/watched_files.h"

namespace nacre {

// The contents of a model file, before the camera, lights and overrides that it is given.
struct ModelAsRead {
  Scene scene;  // without spheres and meshes, which are in LiveScene::scene_
  bool has_camera = false;
  bool own_lights = false;  // overrides have replaced all of its lights
};

class LiveScene {
 public:
  // Reads a scene file or a model. Throws as LoadScene does. `complete`, if set, is called whenever
  // shapes have been read, and adds shapes that no file holds; its exceptions are passed on.
  LiveScene(const std::filesystem::path& path, LoadOptions options,
            std::function<void(Scene*)> complete = {});

  // Reads the text of a scene file; the arguments are those of LoadSceneText.
  LiveScene(std::string_view text, std::string file, std::filesystem::path folder,
            LoadOptions options, std::function<void(Scene*)> complete = {});

  // Reads a document. Its values and changes are never read again, only the files that it names.
  // The options' overrides and environment are ignored.
  LiveScene(SceneDocument document, LoadOptions options, std::function<void(Scene*)> complete = {});

  const Scene& scene() const { return scene_; }

  // Sets the value at `pointer` to the JSON value `json`, as LoadOptions::overrides does, and
  // returns which parts of the scene may have changed. If nothing else depends on the change, only
  // the material or shape that it is in is read again. Throws Error as LoadScene does, and then
  // leaves the scene unchanged.
  SceneChange Set(const std::string& pointer, const std::string& json);

  // For a scene file: its tree with all changes. For a model: the changes only. Plain spheres
  // (SceneTree) are not in it until ListShapes adds them, at half a kilobyte each.
  const Json& root() const { return tree_.root; }
  bool lists_all_shapes() const { return tree_.spheres.runs.empty(); }
  void ListShapes() { nacre::ListShapes(&tree_, &members_); }

  // Whether files that the scene was read from, or that a failed read tried to read, have changed
  // since. Like WatchedFiles::Changed, it is to be called several times a second.
  bool FilesChanged() { return files_.Changed(); }

  // Reads the changed files again, and whatever else of the scene depends on them. Changes made by
  // Set are lost. Returns which parts may have changed. Throws Error as LoadScene does, and then
  // leaves the scene unchanged. Only for scenes that were read from a file.
  SceneParts ReadChangedFiles();

  // Reads again those files named by the scene (for a model, its own file too) that differ now,
  // without waiting for them to settle. Changes made by Set are kept. Returns and throws as
  // ReadChangedFiles does.
  SceneParts ReadNamedFiles();

  // The value at `pointer` as JSON text; for a model, in its ModelTree. nullopt if there is none.
  // Throws Error (kUsage) if `pointer` is not a JSON pointer.
  std::optional<std::string> Get(const std::string& pointer) const;

  // Whether there is a value other than null at `pointer`.
  bool Has(const std::string& pointer) const {
    return model_ ? Get(pointer).value_or("null") != "null" : HasValueIn(tree_, pointer);
  }

  // Replaces the scene's image settings until they are next changed. Nothing that depends on them
  // follows: a model's camera stays.
  void UseImage(const ImageSettings& image) { scene_.image = image; }
  // Replaces a material of the scene until materials are read again.
  void UseMaterial(size_t index, const Material& material) {
    scene_.materials[index] = material;
    members_.current = false;  // the next change reads all of them
  }
  const ImageSettings& own_image() const { return own_image_; }

 private:
  void ReadText(std::string_view text);
  void ReadModelFile(ModelOverrides overrides);
  SceneTree Parse(std::string_view text) const;
  LoadOptions Watching();  // options_ that also add each file that is read to files_; they refer to
                           // *this
  SceneReading Reading() { return {folder_, bytes_, &options_, &kept_, &files_}; }
  // Takes the place of this scene by another one, which was read with Watching().
  SceneParts Become(LiveScene fresh);
  std::optional<SceneChange> ReadItem(const std::string& pointer, std::optional<size_t> shape,
                                      const Replaced& replaced);
  // `material`, if not empty, is the only material of the file that has changed.
  SceneParts ReadAgain(SceneParts touched, const std::string& material = {});
  SceneParts CompleteModel(SceneParts touched);

  std::filesystem::path path_;  // empty: not a file, and `file_` is only a name for errors
  LoadOptions options_;         // without those overrides that are in tree_
  std::vector<std::pair<std::string, std::string>> overrides_;  // the overrides of the options
  std::string file_;
  std::filesystem::path folder_;
  uint64_t bytes_ = 0;
  std::function<void(Scene*)> complete_;
  std::optional<ModelAsRead> model_;  // nullopt: a scene file
  SceneTree tree_;                    // for a scene file: its tree; for a model: the overrides
  Scene scene_;
  ImageSettings own_image_;              // the scene file's or model's, with changes
  bool shapes_bring_materials_ = false;  // or textures
  ReadMembers members_;                  // what was read, so that parts of it can be read again
  KeptFiles kept_;
  WatchedFiles files_;
};

}  // namespace nacre
