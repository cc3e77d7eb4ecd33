// SPDX-License-Identifier: Apache-2.0
#include "scene_io/scene_document.h"

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "scene/validate.h"
#include "scene_io/load_scene.h"
#include "scene_io/model_scene.h"
#include "scene_io/overrides.h"

namespace nacre {

SceneDocument DocumentOfModel(const std::filesystem::path& path) {
  RefuseOtherModels(path);
  return {.model = path,
          .file = path.string(),
          .folder = path.parent_path(),
          .tree = {Json::object(), {}}};
}

SceneDocument ParseDocument(const SceneSource& source, FaultList* faults) {
  return {.model = {},
          .file = source.file,
          .folder = source.folder,
          .bytes = source.text.size(),
          .tree = ParseScene(source, LoadOptions(), faults)};
}

namespace {

// The named entries of a part; nullptr if there is no such part yet.
Json::object_t* NamedEntries(const std::string& part, Json* root) {
  const bool is_named = part == "materials" || part == "lights" || part == "textures";
  if (!is_named || !root->is_object()) return nullptr;
  const auto found = root->find(part);
  return found != root->end() && found->is_object() ? found->get_ptr<Json::object_t*>() : nullptr;
}

Json* FindEntry(const std::string& name, Json::object_t* entries, EntryPlaces* places) {
  const auto at = [&](size_t i) { return entries->begin() + static_cast<ptrdiff_t>(i); };
  for (size_t& i = places->count; i < entries->size(); ++i) {
    places->by_name.try_emplace(at(i)->first, i);
  }
  const auto found = places->by_name.find(name);
  return found != places->by_name.end() ? &at(found->second)->second : nullptr;
}

void PutInFile(const std::string& pointer, const std::string& json, SceneDocument* document) {
  Json* const root = &document->tree.root;
  CompleteTree(pointer, &document->tree);
  const std::vector<std::string> tokens = TokensOf(pointer);
  Json::object_t* const entries = tokens.size() > 1 ? NamedEntries(tokens[0], root) : nullptr;
  if (entries == nullptr) {
    ReplaceInFile(pointer, json, root);
    document->places.clear();
    return;
  }
  Json* const entry = FindEntry(tokens[1], entries, &document->places[tokens[0]]);
  if (entry != nullptr) {
    ReplaceValue(pointer, std::span(tokens).subspan(2), json, entry);
  } else if (tokens.size() == 2) {
    // Appends directly: operator[] would compare the name with all others.
    static_cast<Json::object_t::Container*>(entries)->emplace_back(tokens[1],
                                                                   ParseValue(pointer, json));
  } else {
    ReplaceInFile(pointer, json, root);
  }
}

}  // namespace

void PutValue(const std::string& pointer, const std::string& json, SceneDocument* document) {
  if (document->model.empty()) return PutInFile(pointer, json, document);
  ReplaceValue(pointer, json, &document->tree.root);
  // Setting all of "lights" removes the model's own lights, as in a scene file.
  if (pointer == "/lights") document->own_lights = true;
}

void PutShape(const std::string& json, SceneDocument* document) {
  if (!document->model.empty()) {
    throw Error(ExitCode::kUsage, document->file, "a model takes no shapes as parameters",
                "AddSphere and AddMesh work; or name the model in a mesh of a scene");
  }
  FaultList faults;
  Json shape = ParseJson(json, "AddShape", &faults);
  ThrowFaults(faults, "AddShape");
  Json* const root = &document->tree.root;
  Json* const shapes = root->is_object() ? &(*root)["shapes"] : root;
  if (root->is_object() && shapes->is_null()) *shapes = Json::array();
  if (!root->is_object() || !shapes->is_array()) {
    throw Error(ExitCode::kUsage, "AddShape", "the scene's \"shapes\" are no list",
                "set /shapes to []");
  }
  shapes->push_back(std::move(shape));
}

Scene ReadDocument(const SceneDocument& document, const LoadOptions& options, FaultList* faults) {
  Scene scene;
  if (!document.model.empty()) {
    bool has_camera = false;
    scene = ReadModel(document.model, options, &has_camera);
    const ModelOverrides overrides{document.tree.root, document.own_lights};
    CompleteModelScene({&overrides, &options, document.file, has_camera, nullptr},
                       SceneParts::All(), &scene);
    ThrowFaults(Validate(scene), document.file);
    return scene;
  }
  CheckVersion(document.tree.root, document.file);
  ReadScene(document.tree, SceneParts::All(),
            {.folder = document.folder, .bytes = document.bytes, .options = &options}, faults,
            &scene);
  ThrowFaults(*faults, document.file);
  return scene;
}

}  // namespace nacre
