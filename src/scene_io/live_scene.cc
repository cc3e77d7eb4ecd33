// SPDX-License-Identifier: Apache-2.0
#include "scene_io/live_scene.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "scene/hash.h"
#include "scene/validate.h"
#include "scene_io/load_scene.h"
#include "scene_io/model_scene.h"
#include "scene_io/overrides.h"
#include "scene_io/read_scene.h"
#include "scene_io/scene_json.h"

namespace nacre {
namespace {

constexpr SceneParts kMaterialParts = ScenePart::kMaterials | ScenePart::kTextures;

void SwapParts(SceneParts parts, Scene* a, Scene* b) {
  if (parts.Has(ScenePart::kCamera)) std::swap(a->camera, b->camera);
  if (parts.Has(ScenePart::kImage)) std::swap(a->image, b->image);
  if (parts.Has(ScenePart::kBackground)) std::swap(a->background, b->background);
  if (parts.Has(ScenePart::kTextures)) {
    std::swap(a->images, b->images);
    std::swap(a->textures, b->textures);
  }
  if (parts.Has(ScenePart::kMaterials)) std::swap(a->materials, b->materials);
  if (parts.Has(ScenePart::kLights)) std::swap(a->lights, b->lights);
  if (parts.Has(ScenePart::kShapes)) {
    std::swap(a->spheres, b->spheres);
    std::swap(a->meshes, b->meshes);
    std::swap(a->labels, b->labels);
  }
}

// The parts of the scene that the member at `pointer` defines directly. None for unknown members,
// which the reader of the file reports.
SceneParts PartsOf(const std::string& pointer) {
  struct Member {
    std::string_view name;
    SceneParts parts;
  };
  constexpr std::array<Member, 7> kMembers = {{{"camera", ScenePart::kCamera},
                                               {"image", ScenePart::kImage},
                                               {"background", ScenePart::kBackground},
                                               {"textures", kMaterialParts},
                                               {"materials", kMaterialParts},
                                               {"lights", ScenePart::kLights},
                                               {"shapes", kMaterialParts | ScenePart::kShapes}}};
  if (pointer.empty()) return SceneParts::All();
  const std::string_view name = std::string_view(pointer).substr(1, pointer.find('/', 1) - 1);
  const auto found = std::ranges::find(kMembers, name, &Member::name);
  return found != kMembers.end() ? found->parts : SceneParts();
}

// Whether the materials that the scene had before still have the same indices, judged by their
// names: shapes refer to materials by index.
bool KeepPlaces(const std::vector<Material>& before, const std::vector<Material>& now) {
  const auto same = [](const Material& a, const Material& b) { return a.name == b.name; };
  return now.size() >= before.size() && std::equal(before.begin(), before.end(), now.begin(), same);
}

// The parts of the scene whose members differ between two trees of scene files.
SceneParts DifferingParts(const SceneTree& a, const SceneTree& b) {
  SceneParts parts;
  const auto compare = [&](const Json& some, const Json& others) {
    for (const auto& [name, value] : some.items()) {
      const auto found = others.find(name);
      if (found == others.end() || *found != value) parts |= PartsOf("/" + name);
    }
  };
  compare(a.root, b.root);
  compare(b.root, a.root);
  // Plain spheres are not in the trees; whether they differ is found out by the hash of the shapes.
  if (!a.spheres.runs.empty() || !b.spheres.runs.empty()) parts |= PartsOf("/shapes");
  return parts;
}

// These parts of a scene file with the parts that must be read along with them.
SceneParts WithMaterials(SceneParts parts) {
  return parts.HasAny(kMaterialParts | ScenePart::kShapes) ? parts | kMaterialParts : parts;
}

// The number of the shape that the pointer points at or into.
std::optional<size_t> ShapeNumberOf(const std::vector<std::string>& tokens) {
  if (tokens.size() < 2 || tokens[0] != "shapes") return std::nullopt;
  return ElementOf(tokens[1], static_cast<size_t>(-1));
}

}  // namespace

LiveScene::LiveScene(std::string_view text, std::string file, std::filesystem::path folder,
                     LoadOptions options, std::function<void(Scene*)> complete)
    : options_(std::move(options)),
      file_(std::move(file)),
      folder_(std::move(folder)),
      complete_(std::move(complete)) {
  ReadText(text);
}

LiveScene::LiveScene(const std::filesystem::path& path, LoadOptions options,
                     std::function<void(Scene*)> complete)
    : path_(path),
      options_(std::move(options)),
      file_(path.string()),
      folder_(path.parent_path()),
      complete_(std::move(complete)) {
  RefuseOtherModels(path);
  if (IsModelFile(path)) {
    files_.Add(path, SceneParts::All());
    ReadModelFile(OverridesOf(options_));
  } else {
    files_.Add(path, {});  // what has changed is found by comparing trees
    ReadText(ReadSceneText(path));
  }
}

LiveScene::LiveScene(SceneDocument document, LoadOptions options,
                     std::function<void(Scene*)> complete)
    : path_(std::move(document.model)),
      options_(std::move(options)),
      file_(std::move(document.file)),
      folder_(std::move(document.folder)),
      bytes_(document.bytes),
      complete_(std::move(complete)) {
  if (!path_.empty()) {
    files_.Add(path_, SceneParts::All());
    ReadModelFile({std::move(document.tree.root), document.own_lights});
    return;
  }
  tree_ = std::move(document.tree);
  ReadAgain(SceneParts::All());
}

SceneTree LiveScene::Parse(std::string_view text) const {
  LoadOptions options = options_;
  options.overrides = overrides_;
  FaultList faults;
  SceneTree tree = ParseScene({text, file_, folder_}, options, &faults);
  ThrowFaults(faults, file_);
  return tree;
}

void LiveScene::ReadText(std::string_view text) {
  overrides_ = std::move(options_.overrides);
  options_.overrides.clear();
  bytes_ = text.size();
  tree_ = Parse(text);
  ReadAgain(SceneParts::All());
}

void LiveScene::ReadModelFile(ModelOverrides overrides) {
  model_.emplace();
  model_->scene = ReadModel(path_, Watching(), &model_->has_camera);
  tree_.root = std::move(overrides.root);
  model_->own_lights = overrides.own_lights;
  SwapParts(ScenePart::kShapes, &scene_, &model_->scene);
  CompleteModel(SceneParts::All());
  if (complete_) complete_(&scene_);
}

SceneParts LiveScene::ReadChangedFiles() {
  if (model_) {
    // Reads everything again. If that fails, the files that it tried to read are watched from then
    // on.
    return Become(LiveScene(path_, Watching(), complete_));
  }
  const std::string text = ReadSceneText(path_);
  SceneTree other = Parse(text);
  uint64_t other_bytes = text.size();
  const SceneParts touched = WithMaterials(DifferingParts(other, tree_) | files_.ChangedParts());
  const auto swap = [&] {
    std::swap(other, tree_);
    std::swap(other_bytes, bytes_);
  };
  swap();
  try {
    const SceneParts parts = ReadAgain(touched);
    files_.ForgetChanges();
    return parts;
  } catch (...) {
    swap();
    throw;
  }
}

SceneParts LiveScene::ReadNamedFiles() {
  files_.Changed(std::chrono::milliseconds(0));
  const SceneParts touched = files_.ChangedParts();
  if (touched.empty()) return touched;
  if (!model_) {
    const SceneParts parts = ReadAgain(WithMaterials(touched));
    files_.ForgetChanges();
    return parts;
  }
  return Become(
      LiveScene({path_, file_, folder_, bytes_, tree_, model_->own_lights}, Watching(), complete_));
}

SceneParts LiveScene::Become(LiveScene fresh) {
  fresh.options_.on_file = std::move(options_.on_file);
  *this = std::move(fresh);
  return SceneParts::All();
}

LoadOptions LiveScene::Watching() {
  LoadOptions options = options_;
  options.on_file = [this](const std::filesystem::path& file) {
    files_.Add(file, SceneParts::All());
    if (options_.on_file) options_.on_file(file);
  };
  return options;
}

SceneChange LiveScene::Set(const std::string& pointer, const std::string& json) {
  const std::optional<size_t> number = ShapeNumberOf(TokensOf(pointer));
  const std::optional<size_t> shape =
      number && !model_ ? MovePlainSphereToTree(*number, &tree_, &members_) : std::nullopt;
  if (!shape && (pointer.empty() || pointer.starts_with("/shapes"))) ListShapes();
  Json* const root = &tree_.root;
  Replaced replaced =
      model_ ? ReplaceValue(pointer, json, root) : ReplaceInFile(pointer, json, root, shape);
  const bool own_lights = model_ && model_->own_lights;
  try {
    if (!model_) {
      if (std::optional<SceneChange> change = ReadItem(pointer, shape, replaced)) return *change;
      const bool one_material = replaced.path.size() > 1 && replaced.path[0] == "materials";
      return ReadAgain(PartsOf(pointer), one_material ? replaced.path[1] : std::string());
    }
    if (pointer == "/lights") model_->own_lights = true;
    return CompleteModel(PartsOf(pointer));
  } catch (...) {
    if (model_) model_->own_lights = own_lights;
    PutBack(std::move(replaced), root);
    throw;
  }
}

std::optional<SceneChange> LiveScene::ReadItem(const std::string& pointer,
                                               std::optional<size_t> shape,
                                               const Replaced& replaced) {
  const std::vector<std::string> tokens = TokensOf(pointer);
  if (tokens.size() < 2) return std::nullopt;
  if (tokens[0] == "materials") {
    return ReadMaterialAlone(tree_, tokens[1], Reading(), &members_, &scene_);
  }
  if (!shape) return std::nullopt;
  const bool was_displaced = tokens.size() == 2 && replaced.value->contains("displacement");
  if (was_displaced) return std::nullopt;
  return ReadShapeAlone(tree_, *shape, *ShapeNumberOf(tokens), Reading(), &members_, &scene_);
}

std::optional<std::string> LiveScene::Get(const std::string& pointer) const {
  const std::optional<Json> value =
      model_ ? ValueIn({ModelTree(scene_, own_image_, tree_.root), {}}, pointer)
             : ValueIn(tree_, pointer);
  return value ? std::optional(JsonText(*value)) : std::nullopt;
}

SceneParts LiveScene::ReadAgain(SceneParts touched, const std::string& material) {
  CheckVersion(tree_.root, file_);
  SceneParts parts = touched;
  // What shapes have brought does not depend on another material, but may depend on textures.
  const auto known = members_.names.find(material);
  const bool varied =
      known != members_.names.end() && members_.varied.contains(known->second.index);
  const bool brought = shapes_bring_materials_ && parts.Has(ScenePart::kMaterials);
  const bool take_over = brought && !material.empty() && !varied;
  if (brought && !take_over) parts |= ScenePart::kShapes;
  const SceneParts others = SceneParts::All().Without(parts);
  Scene next;
  SwapParts(others, &scene_, &next);
  bool moved = false;
  try {
    FaultList faults;
    SceneReading reading = Reading();
    reading.before = take_over ? &scene_ : nullptr;
    reading.members = &members_;
    std::optional<ReadMembers> read = ReadScene(tree_, parts, reading, &faults, &next);
    ThrowFaults(faults, file_);
    const bool has_shapes = parts.Has(ScenePart::kShapes);
    moved = parts.Has(ScenePart::kMaterials) && !has_shapes &&
            (!read || !KeepPlaces(scene_.materials, next.materials));
    if (has_shapes) {
      if (complete_) complete_(&next);
      shapes_bring_materials_ =
          next.materials.size() > read->materials || next.textures.size() > read->textures;
      members_ = *std::move(read);
    } else if (parts.Has(ScenePart::kMaterials) && !moved) {
      // The shapes have not been read again.
      read->varied = std::move(members_.varied);
      read->shapes = std::move(members_.shapes);
      read->runs = std::move(members_.runs);
      members_ = *std::move(read);
    }
  } catch (...) {
    SwapParts(others, &scene_, &next);
    throw;
  }
  if (moved) {
    SwapParts(others, &scene_, &next);
    return ReadAgain(touched | ScenePart::kShapes);
  }
  std::swap(scene_, next);
  if (parts.Has(ScenePart::kImage)) own_image_ = scene_.image;
  DropUnheld(&kept_);
  if (!parts.Has(ScenePart::kShapes)) return parts;
  // Shapes that were read along with materials, or from a file that was saved, are mostly
  // unchanged. Then the old ones are kept, since others may hold pointers to them.
  if (HashShapes(next) != HashShapes(scene_)) return parts;
  SwapParts(ScenePart::kShapes, &scene_, &next);
  std::swap(scene_.labels, next.labels);
  return parts.Without(ScenePart::kShapes);
}

SceneParts LiveScene::CompleteModel(SceneParts touched) {
  SceneParts parts = touched;
  if (parts.Has(ScenePart::kImage)) parts |= ScenePart::kCamera;
  if (parts.HasAny(ScenePart::kCamera | ScenePart::kLights)) {
    parts |= ScenePart::kLights | ScenePart::kBackground;
  }
  // Shapes always are those of the file, except for texture coordinates that maps may need.
  parts = parts.Without(ScenePart::kShapes);
  const SceneParts others = SceneParts::All().Without(parts);
  Scene next = model_->scene;
  SwapParts(others, &scene_, &next);
  const ModelOverrides overrides{tree_.root, model_->own_lights};
  const LoadOptions options = Watching();
  bool new_coordinates = false;
  try {
    new_coordinates =
        CompleteModelScene({&overrides, &options, file_, model_->has_camera, &kept_}, parts, &next);
    ThrowFaults(Validate(next, touched == SceneParts::All() ? touched : parts), file_);
  } catch (...) {
    SwapParts(others, &scene_, &next);
    throw;
  }
  std::swap(scene_, next);
  if (parts.Has(ScenePart::kImage)) own_image_ = scene_.image;
  DropUnheld(&kept_);
  return new_coordinates ? parts | ScenePart::kShapes : parts;
}

}  // namespace nacre
