// SPDX-License-Identifier: Apache-2.0
#include "scene_io/load_scene.h"

#include <array>

#include <fmt/format.h>

#include "base/error.h"
#include "base/path.h"
#include "scene/validate.h"
#include "scene_io/model_files.h"
#include "scene_io/model_scene.h"
#include "scene_io/overrides.h"
#include "scene_io/read_scene.h"
#include "scene_io/text_file.h"

namespace nacre {
namespace {

// Reads a model, and adds a camera and light where it has none.
Scene LoadModel(const std::filesystem::path& path, const LoadOptions& options) {
  const std::string file = path.string();
  bool has_camera = false;
  Scene scene = ReadModel(path, options, &has_camera);
  const ModelOverrides overrides = OverridesOf(options);
  CompleteModelScene({&overrides, &options, file, has_camera, nullptr}, SceneParts::All(), &scene);
  ThrowFaults(Validate(scene), file);
  return scene;
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
      Other{".mtlx", "is a MaterialX document, which has materials and no shapes",
            "`nacre grid --material` shows one; scenes name them by {\"file\": \"x.mtlx\"}"},
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

Scene ReadModel(const std::filesystem::path& path, const LoadOptions& options, bool* has_camera) {
  const std::string file = path.string();
  if (!HasExtension(file, ".gltf") && !HasExtension(file, ".glb")) RefuseVariant(options);
  if (HasExtension(file, ".obj")) return ReadObjScene(path, options);
  if (HasExtension(file, ".ply")) return ReadPlyScene(path, options);
  return ReadGltf(path, options, has_camera);
}

std::string ReadSceneText(const std::filesystem::path& path) {
  constexpr uint64_t kMaxSceneBytes = uint64_t{1} << 30;
  return ReadTextFile(path, kMaxSceneBytes);
}

Scene LoadScene(const std::filesystem::path& path, const LoadOptions& options) {
  RefuseOtherModels(path);
  if (IsModelFile(path)) return LoadModel(path, options);
  const std::string text = ReadSceneText(path);
  return LoadSceneText(text, path.string(), path.parent_path(), options);
}

Scene LoadSceneText(std::string_view text, const std::string& file,
                    const std::filesystem::path& folder, const LoadOptions& options) {
  return ReadSceneSource({text, file, folder}, options);
}

Material LoadMaterialText(std::string_view json, const std::string& file,
                          const LoadOptions& options) {
  const std::string scene = fmt::format(R"({{"nacre": 1, "materials": {{"material": {}}}}})", json);
  Material material = LoadSceneText(scene, file, ".", options).materials.front();
  material.name.clear();
  return material;
}

}  // namespace nacre
