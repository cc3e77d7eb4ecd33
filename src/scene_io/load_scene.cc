// SPDX-License-Identifier: Apache-2.0
#include "scene_io/load_scene.h"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include "base/error.h"
#include "base/path.h"
#include "base/version.h"
#include "scene/validate.h"
#include "scene_io/gltf.h"
#include "scene_io/model_scene.h"
#include "scene_io/obj.h"
#include "scene_io/overrides.h"
#include "scene_io/ply.h"
#include "scene_io/readers.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

constexpr uint64_t kMaxSceneBytes = uint64_t{1} << 30;
constexpr int kFormat = 1;  // the version of scene files

// What is wrong with a version that this program does not read, and the way to one that it does.
Fault JudgeVersion(const Json& version, const std::string& where) {
  const std::string reads = fmt::format("nacre {} reads version {}", kVersion, kFormat);
  if (!version.is_number()) return {where, "the version is not a number", reads};
  if (version > kFormat) {
    return {
        where,
        fmt::format("version {} of the scene format is newer than this program", JsonText(version)),
        fmt::format("{}: take a newer nacre, or write the scene as version {}", reads, kFormat)};
  }
  // Version 1 is the first: nothing older is to be translated.
  return {where, fmt::format("there is no version {} of the scene format", JsonText(version)),
          fmt::format("{}: write \"nacre\": {}; `nacre schema` prints what it may hold", reads,
                      kFormat)};
}

std::string VersionHint() {
  return fmt::format("\"nacre\": {}, the version of the format", kFormat);
}

// Before overrides, which would blame the command line.
void CheckIsObject(const Json& root, const std::string& file) {
  if (root.is_object()) return;
  throw Error(ExitCode::kBadInput, file, "not a scene: no object",
              "a scene begins {" + VersionHint());
}

// Throws if the rest of the file cannot mean anything to this program.
void CheckVersion(const Json& root, const std::string& file) {
  CheckIsObject(root, file);  // an override may have replaced all of it
  const auto version = root.find("nacre");
  if (version == root.end()) {
    throw Error(ExitCode::kBadInput, file, "not a scene: missing key \"nacre\"",
                "add " + VersionHint());
  }
  if (version->is_number() && *version == kFormat) return;
  throw Error(ExitCode::kBadInput, {JudgeVersion(*version, PlaceInFile(file, "/nacre"))});
}

void ReadRoot(const Json& root, FaultList* faults, SceneContext* context) {
  JsonObject object({root, JsonPath{}, faults});
  Scene* const scene = context->scene;
  const auto member = [&](std::string_view name, auto&& read) {
    if (const Json* json = object.Find(name)) {
      read(JsonValue{*json, object.path().Member(name), faults});
    }
  };
  std::string schema;
  object.Text("$schema", &schema);  // for editors
  object.Find("nacre");
  member("camera", [&](const JsonValue& value) { ReadCamera(value, &scene->camera); });
  member("image", [&](const JsonValue& value) { ReadImage(value, &scene->image); });
  member("textures", [&](const JsonValue& value) { ReadTextures(value, context); });
  member("materials", [&](const JsonValue& value) { ReadMaterials(value, context); });
  member("lights", [&](const JsonValue& value) { ReadLights(value, *context, &scene->lights); });
  member("shapes", [&](const JsonValue& value) { ReadShapes(value, context); });
  object.Color("background", limits::kRadiance, &scene->background);
  object.RefuseOthers();
}

// The part of a scene that a pointer is in: "/camera", "/lights/key", "/shapes".
std::string PartOf(const std::string& pointer) {
  if (pointer.starts_with("/spheres") || pointer.starts_with("/meshes")) return "/shapes";
  const bool is_named = pointer.starts_with("/materials/") || pointer.starts_with("/lights/") ||
                        pointer.starts_with("/textures/");
  const size_t first_end = pointer.find('/', 1);
  return pointer.substr(0, is_named ? pointer.find('/', first_end + 1) : first_end);
}

// Adds what Validate() finds in parts that could be read: elsewhere it would judge the defaults
// that stand in for what could not.
void AddValidation(const Scene& scene, FaultList* faults) {
  std::set<std::string> faulty_parts;
  for (const Fault& fault : faults->kept()) faulty_parts.insert(PartOf(fault.where));
  if (faulty_parts.contains("/materials")) faulty_parts.insert("/shapes");  // they name them
  for (const Fault& fault : Validate(scene)) {
    const bool is_remainder = fault.where.empty();  // "and 7 more": of which parts?
    if (is_remainder && !faulty_parts.empty()) continue;
    if (!faulty_parts.contains(PartOf(fault.where))) {
      faults->Add(fault.where, fault.what, fault.hint);
    }
  }
}

}  // namespace

Scene LoadSceneText(std::string_view text, const std::string& file,
                    const std::filesystem::path& folder, const LoadOptions& options) {
  FaultList faults;
  Json root = ParseJson(text, file, &faults, options.on_progress);
  CheckIsObject(root, file);
  try {
    ApplyOptionsToFile(options, &root);
  } catch (const Error&) {
    // The fault may be the file's: "image": [] has no place for --size. Then that is told.
    LoadOptions file_alone = options;
    file_alone.overrides.clear();
    file_alone.on_warning = nullptr;
    if (!options.overrides.empty()) LoadSceneText(text, file, folder, file_alone);
    throw;
  }
  CheckVersion(root, file);

  Scene scene;
  SceneContext context;
  context.folder = folder;
  context.references = RulesOf(options);
  context.threads = options.threads;
  context.scene = &scene;
  context.on_warning = options.on_warning;
  SceneBudget budget(options.max_primitives.value_or(kDefaultMaxPrimitives));
  context.budget = &budget;
  TexelBudget texels(text.size());
  context.texels = &texels;
  ReadRoot(root, &faults, &context);
  AddValidation(scene, &faults);
  ThrowFaults(faults, file);
  return scene;
}

namespace {

// A model with camera and light added where it has none.
Scene LoadModel(const std::filesystem::path& path, const LoadOptions& options) {
  const std::string file = path.string();
  bool has_camera = false;
  Scene scene = HasExtension(file, ".obj")   ? ReadObjScene(path, options)
                : HasExtension(file, ".ply") ? ReadPlyScene(path, options)
                                             : ReadGltf(path, options, &has_camera);
  CompleteModelScene(options, file, has_camera, &scene);
  std::vector<Fault> faults = Validate(scene);
  if (faults.empty()) return scene;
  for (Fault& fault : faults) fault.where = PlaceInFile(file, fault.where);
  throw Error(ExitCode::kBadInput, std::move(faults));
}

}  // namespace

bool IsModelFile(const std::filesystem::path& path) {
  const std::string file = path.string();
  return HasExtension(file, ".gltf") || HasExtension(file, ".glb") || HasExtension(file, ".obj") ||
         HasExtension(file, ".ply");
}

void RefuseOtherModels(const std::filesystem::path& path) {
  struct Format {
    std::string_view extension, name;
  };
  struct Other {
    std::string_view extension, what, hint;
  };
  constexpr std::array kConverted = {
      Format{".fbx", "an FBX"},  Format{".stl", "an STL"},      Format{".blend", "a Blender"},
      Format{".usd", "a USD"},   Format{".usda", "a USD"},      Format{".usdc", "a USD"},
      Format{".usdz", "a USD"},  Format{".abc", "an Alembic"},  Format{".dae", "a Collada"},
      Format{".3ds", "a 3DS"},   Format{".max", "a 3ds Max"},   Format{".ma", "a Maya"},
      Format{".mb", "a Maya"},   Format{".c4d", "a Cinema 4D"}, Format{".lwo", "a LightWave"},
      Format{".x3d", "an X3D"},  Format{".wrl", "a VRML"},      Format{".step", "a STEP"},
      Format{".stp", "a STEP"},  Format{".iges", "an IGES"},    Format{".igs", "an IGES"},
      Format{".3mf", "a 3MF"},   Format{".off", "an OFF"},      Format{".skp", "a SketchUp"},
      Format{".pbrt", "a pbrt"}, Format{".xml", "an XML"}};
  constexpr std::array kOthers = {
      Other{".mtl", "is a material library", "name the .obj file that refers to it"},
      Other{".mtlx", "is a MaterialX document, which is not read",
            "write its materials into a scene, or export a model with them as glTF"},
      Other{".vrm", "is a VRM model, which is a GLB file of another name", "rename it to .glb"},
      Other{".bin", "is the buffer of a glTF file", "name the .gltf file that refers to it"},
      Other{".zip", "is an archive", "unpack it, and name the .gltf, .glb or .obj file in it"},
      Other{".gz", "is compressed", "unpack it first"}};
  const std::string file = path.string();
  for (const Format& format : kConverted) {
    if (!HasExtension(file, format.extension)) continue;
    throw Error(ExitCode::kBadInput, file,
                fmt::format("is {} file, which is not read", format.name),
                "save it as glTF (.glb), OBJ or PLY, for example with Blender");
  }
  for (const auto& [extension, what, hint] : kOthers) {
    if (!HasExtension(file, extension)) continue;
    throw Error(ExitCode::kBadInput, file, std::string(what), std::string(hint));
  }
}

Scene LoadScene(const std::filesystem::path& path, const LoadOptions& options) {
  RefuseOtherModels(path);
  if (IsModelFile(path)) return LoadModel(path, options);
  const std::string text = ReadTextFile(path, kMaxSceneBytes);
  return LoadSceneText(text, path.string(), path.parent_path(), options);
}

}  // namespace nacre
