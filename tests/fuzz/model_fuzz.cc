// SPDX-License-Identifier: Apache-2.0
// tests/fuzz/model_fuzz.cc: model files: OBJ with MTL, PLY, glTF as text and as bytes; tables of
// spheres; MaterialX documents.
#include "fuzz/fuzz_input.h"
#include "fuzz/targets.h"
#include "scene/hash.h"
#include "scene_io/materialx.h"

namespace nacre {
namespace {

void ReadModel(const std::filesystem::path& path) {
  ReadOrRefuse([&] { HashScene(LoadScene(path, SmallScenes())); });
}

}  // namespace

void FuzzObj(std::string_view bytes) {
  constexpr std::string_view kSeparator = "\n# mtl\n";
  const size_t separator = std::min(bytes.find(kSeparator), bytes.size());
  const std::string_view obj = bytes.substr(0, separator);
  const std::string_view rest = bytes.substr(separator);
  const std::string_view mtl = rest.empty() ? rest : rest.substr(kSeparator.size());
  SharedFolder().Write("fuzz.mtl", mtl);
  ReadModel(SharedFolder().Write("fuzz.obj", obj));
}

void FuzzMaterialX(std::string_view bytes) {
  constexpr std::string_view kSeparator = "\n<!-- included -->\n";
  const size_t separator = std::min(bytes.find(kSeparator), bytes.size());
  const std::string_view rest = bytes.substr(separator);
  SharedFolder().Write("included.mtlx", rest.substr(std::min(kSeparator.size(), rest.size())));
  SharedFolder().Write("fuzz.mtlx", bytes.substr(0, separator));
  ReadOrRefuse([&] {
    HashScene(LoadSceneText(R"({"nacre": 1, "materials": {"a": {"file": "fuzz.mtlx"}, )"
                            R"("b": {"file": "fuzz.mtlx", "material": "b", "emission": 1}}})",
                            "scene.json", SharedFolder().path(), SmallScenes()));
  });
  // Alone, too, as a scene with faults has no material.
  ReadOrRefuse([&] { ReadMaterialX(SharedFolder().path(), "fuzz.mtlx", "", {}); });
}

void FuzzPly(std::string_view bytes) { ReadModel(SharedFolder().Write("fuzz.ply", bytes)); }

// By its first bytes a file of one of three kinds. Numbers are places in the list of materials.
void FuzzSphereFile(std::string_view bytes) {
  const std::string name = bytes.starts_with("\x93NUMPY") ? "fuzz.npy"
                           : bytes.starts_with("ply")     ? "points.ply"
                                                          : "fuzz.csv";
  SharedFolder().Write(name, bytes);
  ReadOrRefuse([&] {
    const std::string scene =
        R"({"nacre": 1, "materials": {"a": {"model": "lambert"}, "b": {"model": "lambert"}},)"
        R"("shapes": [{"type": "spheres", "radius": 1, "material": "a", "materials": ["b", "a"],)"
        R"("file": ")" +
        name + "\"}]}";
    HashScene(LoadSceneText(scene, "scene.json", SharedFolder().path(), SmallScenes()));
  });
}

void FuzzGltf(std::string_view bytes) { ReadModel(SharedFolder().Write("fuzz.gltf", bytes)); }

void FuzzGlb(std::string_view bytes) { ReadModel(SharedFolder().Write("fuzz.glb", bytes)); }

}  // namespace nacre
