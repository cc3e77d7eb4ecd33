// SPDX-License-Identifier: Apache-2.0
#include "scene_io/read_scene.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/version.h"
#include "scene/idle_layers.h"
#include "scene/validate.h"
#include "scene_io/overrides.h"
#include "scene_io/readers.h"
#include "scene_io/scene_budget.h"

namespace nacre {
namespace {

constexpr int kFormat = 1;  // the version of the format that is read

// Describes a version that this program does not read, with a hint how to get one that it does.
Fault JudgeVersion(const Json& version, const std::string& where) {
  const std::string reads = fmt::format("nacre {} reads version {}", kVersion, kFormat);
  if (!version.is_number()) return {where, "the version is not a number", reads};
  if (version > kFormat) {
    return {
        where,
        fmt::format("version {} of the scene format is newer than this program", JsonText(version)),
        fmt::format("{}: take a newer nacre, or write the scene as version {}", reads, kFormat)};
  }
  // Version 1 is the first: there are no older ones to translate.
  return {where, fmt::format("there is no version {} of the scene format", JsonText(version)),
          fmt::format("{}: write \"nacre\": {}; `nacre schema` prints what it may hold", reads,
                      kFormat)};
}

std::string VersionHint() {
  return fmt::format("\"nacre\": {}, the version of the format", kFormat);
}

// Checked before overrides are applied, whose error would blame the command line.
void CheckIsObject(const Json& root, const std::string& file) {
  if (root.is_object()) return;
  throw Error(ExitCode::kBadInput, file, "not a scene: no object",
              "a scene begins {" + VersionHint());
}

// Reads the given parts. Members for other parts are recognised, but not read.
void ReadRoot(const SceneTree& tree, SceneParts parts, FaultList* faults, SceneContext* context,
              ScenePart* being_read) {
  JsonObject object({tree.root, JsonPath{}, faults});
  Scene* const scene = context->scene;
  const auto member = [&](std::string_view name, ScenePart part, const auto& read_member) {
    const auto value = object.Find(name);
    if (!value || !parts.Has(part)) return;
    *being_read = part;
    read_member(*value);
  };
  std::string schema;
  object.Text("$schema", &schema);  // used by editors
  object.Find("nacre");
  member("camera", ScenePart::kCamera,
         [&](const JsonValue& value) { ReadCamera(value, &scene->camera); });
  member("image", ScenePart::kImage,
         [&](const JsonValue& value) { ReadImageSettings(value, &scene->image); });
  member("textures", ScenePart::kTextures,
         [&](const JsonValue& value) { ReadTextures(value, context); });
  member("materials", ScenePart::kMaterials, [&](const JsonValue& value) {
    DecodeMapsAhead(value.json, context);
    ReadMaterials(value, context);
  });
  context->read.materials = scene->materials.size();
  context->read.textures = scene->textures.size();
  context->read.images = scene->images.size();
  member("lights", ScenePart::kLights,
         [&](const JsonValue& value) { ReadLights(value, *context, &scene->lights); });
  member("shapes", ScenePart::kShapes,
         [&](const JsonValue& value) { ReadShapes(value, tree.spheres, context); });
  member("background", ScenePart::kBackground,
         [&](const JsonValue& value) { ReadColor(value, limits::kRadiance, &scene->background); });
  object.RefuseOthers();
  context->read.current = true;
}

// Adds what shapes had brought to the materials, textures and images that the file defines. Returns
// false, and adds nothing, unless these have the same indices as before, by which shapes refer to
// textures and images.
bool TakeOverBrought(const Scene& before, const ReadMembers& members, ReadMembers* now,
                     Scene* scene) {
  const auto same_image = [](const SceneImage& a, const SceneImage& b) {
    return a.texels == b.texels && a.middle == b.middle && a.lacks_alpha == b.lacks_alpha;
  };
  const bool fits =
      now->materials == members.materials && now->textures == members.textures &&
      now->images == members.images &&
      std::equal(scene->textures.begin(), scene->textures.end(), before.textures.begin()) &&
      std::equal(scene->images.begin(), scene->images.end(), before.images.begin(), same_image);
  if (!fits) return false;
  const auto take = [](const auto& from, size_t first, auto* to) {
    to->insert(to->end(), from.begin() + static_cast<ptrdiff_t>(first), from.end());
  };
  take(before.materials, members.materials, &scene->materials);
  for (const auto& [place, whole] : members.whole) {
    if (place >= members.materials) now->whole.emplace(place, whole);
  }
  take(before.textures, members.textures, &scene->textures);
  take(before.images, members.images, &scene->images);
  return true;
}

// The part of a scene that a pointer belongs to: "/camera", "/lights/key", "/shapes".
std::string PartOf(const std::string& pointer) {
  if (pointer.starts_with("/spheres") || pointer.starts_with("/meshes")) return "/shapes";
  const bool is_named = pointer.starts_with("/materials/") || pointer.starts_with("/lights/") ||
                        pointer.starts_with("/textures/");
  const size_t first_end = pointer.find('/', 1);
  return pointer.substr(0, is_named ? pointer.find('/', first_end + 1) : first_end);
}

// Adds what Validate() finds in parts that were read without faults; in others it would judge the
// defaults that replace what could not be read.
void AddValidation(const Scene& scene, SceneParts parts, FaultList* faults) {
  std::set<std::string> faulty_parts;
  for (const Fault& fault : faults->kept()) faulty_parts.insert(PartOf(fault.where));
  // Shapes refer to materials.
  if (faulty_parts.contains("/materials")) faulty_parts.insert("/shapes");
  for (const Fault& fault : Validate(scene, parts)) {
    const bool is_remainder = fault.where.empty();  // "and 7 more": of unknown parts
    if (is_remainder && !faulty_parts.empty()) continue;
    if (!faulty_parts.contains(PartOf(fault.where))) {
      faults->Add(fault.where, fault.what, fault.hint);
    }
  }
}

}  // namespace

std::optional<ShapePlace> FindShape(size_t place, const SceneTree& tree) {
  const auto shapes = tree.root.find("shapes");
  if (shapes == tree.root.end() || !shapes->is_array()) return std::nullopt;
  const std::vector<SphereRun>& runs = tree.spheres.runs;
  const auto next =
      std::upper_bound(runs.begin(), runs.end(), place,
                       [](size_t number, const SphereRun& run) { return number < run.first; });
  size_t number = place;
  if (next != runs.begin()) {
    const auto run = std::prev(next);
    number -= run->first;
    if (number < run->spheres.size()) {
      return ShapePlace{static_cast<size_t>(run - runs.begin()), number};
    }
    number = run->in_tree + number - run->spheres.size();
  }
  if (number >= shapes->size()) return std::nullopt;
  return ShapePlace{std::nullopt, number};
}

std::optional<Json> ValueIn(const SceneTree& tree, const std::string& pointer) {
  const std::vector<std::string> tokens = TokensOf(pointer);
  std::span<const std::string> rest(tokens);
  const auto copy_in = [&](const Json& from) {
    std::optional<Json> copy;
    if (const Json* const found = FindValue(rest, from)) copy.emplace(*found);
    return copy;
  };
  const std::vector<SphereRun>& runs = tree.spheres.runs;
  if (runs.empty() || (!rest.empty() && rest[0] != "shapes")) return copy_in(tree.root);
  if (rest.size() < 2) {
    SceneTree whole = tree;
    CompleteTree(pointer, &whole);
    return copy_in(whole.root);
  }
  const std::optional<size_t> element = ElementOf(rest[1], static_cast<size_t>(-1));
  const std::optional<ShapePlace> place = element ? FindShape(*element, tree) : std::nullopt;
  if (!place) return std::nullopt;
  rest = rest.subspan(2);
  if (!place->run) return copy_in(tree.root.at("shapes")[place->number]);
  const Sphere& sphere = runs[*place->run].spheres[place->number];
  return copy_in(JsonOf(sphere, tree.spheres.MaterialOf(sphere)));
}

bool HasValueIn(const SceneTree& tree, const std::string& pointer) {
  const std::vector<std::string> tokens = TokensOf(pointer);
  if (tokens.size() > 1 && tokens[0] == "shapes" && !tree.spheres.runs.empty()) {
    const std::optional<Json> value = ValueIn(tree, pointer);
    return value && !value->is_null();
  }
  const Json* const found = FindValue(tokens, tree.root);
  return found != nullptr && !found->is_null();
}

void CompleteTree(const std::string& pointer, SceneTree* tree) {
  std::vector<SphereRun>& runs = tree->spheres.runs;
  if (runs.empty() || !(pointer.empty() || pointer.starts_with("/shapes"))) return;
  auto& shapes = tree->root["shapes"].get_ref<Json::array_t&>();
  Json::array_t all;
  auto run = runs.begin();
  for (Json& shape : shapes) {
    all.push_back(std::move(shape));
    if (run == runs.end() || run->first != all.size()) continue;
    for (const Sphere& sphere : run->spheres) {
      all.push_back(JsonOf(sphere, tree->spheres.MaterialOf(sphere)));
    }
    ++run;
  }
  shapes = std::move(all);
  tree->spheres = {};
}

SceneTree ParseScene(const SceneSource& source, const LoadOptions& options, FaultList* faults) {
  const std::string& file = source.file;
  SceneTree tree;
  tree.root = ParseJson(source.text, file, faults, options.on_progress, &tree.spheres);
  CheckIsObject(tree.root, file);
  for (const auto& [pointer, value] : options.overrides) CompleteTree(pointer, &tree);
  try {
    ApplyOptionsToFile(options, &tree.root);
  } catch (const Error&) {
    // The file may be at fault: "image": [] has no place for --size. Then that error is thrown.
    LoadOptions file_alone = options;
    file_alone.overrides.clear();
    file_alone.on_warning = nullptr;
    if (!options.overrides.empty()) ReadSceneSource(source, file_alone);
    throw;
  }
  CheckVersion(tree.root, file);
  return tree;
}

Scene ReadSceneSource(const SceneSource& source, const LoadOptions& options) {
  FaultList faults;
  const SceneTree tree = ParseScene(source, options, &faults);
  Scene scene;
  const SceneReading reading{
      .folder = source.folder, .bytes = source.text.size(), .options = &options};
  ReadScene(tree, SceneParts::All(), reading, &faults, &scene);
  ThrowFaults(faults, source.file);
  return scene;
}

void CheckVersion(const Json& root, const std::string& file) {
  CheckIsObject(root, file);  // an override may have replaced the root
  const auto version = root.find("nacre");
  if (version == root.end()) {
    throw Error(ExitCode::kBadInput, file, "not a scene: missing key \"nacre\"",
                "add " + VersionHint());
  }
  if (version->is_number() && *version == kFormat) return;
  throw Error(ExitCode::kBadInput, {JudgeVersion(*version, PlaceInFile(file, "/nacre"))});
}

void SetUpContext(const SceneReading& reading, const ScenePart* part, SceneBudget* budget,
                  TexelBudget* texels, Scene* scene, SceneContext* context) {
  const LoadOptions& options = *reading.options;
  context->folder = reading.folder;
  context->references = RulesOf(options);
  if (reading.files != nullptr) {
    context->references.on_file = [part, files = reading.files,
                                   tell = options.on_file](const std::filesystem::path& file) {
      files->Add(file, *part);
      if (tell) tell(file);
    };
  }
  context->threads = options.threads;
  context->user_brdfs = &options.user_brdfs;
  context->scene = scene;
  context->budget = budget;
  context->texels = texels;
  context->on_warning = options.on_warning;
  context->kept = reading.kept;
}

std::optional<ReadMembers> ReadScene(const SceneTree& tree, SceneParts parts,
                                     const SceneReading& reading, FaultList* faults, Scene* scene) {
  SceneContext context;
  SceneBudget budget(reading.options->max_primitives.value_or(kDefaultMaxPrimitives));
  TexelBudget texels(reading.bytes);
  ScenePart being_read = ScenePart::kCamera;
  SetUpContext(reading, &being_read, &budget, &texels, scene, &context);
  ReadRoot(tree, parts, faults, &context, &being_read);
  ReadMembers& read = context.read;
  if (reading.before != nullptr &&
      !TakeOverBrought(*reading.before, *reading.members, &read, scene)) {
    return std::nullopt;
  }
  // This comes last, because generators may vary what a material leaves idle. Shapes are never read
  // without materials.
  if (parts.Has(ScenePart::kMaterials)) {
    for (uint32_t i = 0; i < scene->materials.size(); ++i) {
      std::optional<Material> whole = RemoveIdleLayers(*scene, &scene->materials[i]);
      if (whole) read.whole.emplace(i, *std::move(whole));
    }
  }
  AddValidation(*scene, parts, faults);
  return std::move(read);
}

}  // namespace nacre
