// SPDX-License-Identifier: Apache-2.0
// tests/fuzz/model_fuzz.cc: model files: OBJ with MTL, PLY, glTF as text and as bytes.
#include "fuzz/fuzz_input.h"
#include "fuzz/targets.h"
#include "scene/hash.h"

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

void FuzzPly(std::string_view bytes) { ReadModel(SharedFolder().Write("fuzz.ply", bytes)); }

void FuzzGltf(std::string_view bytes) { ReadModel(SharedFolder().Write("fuzz.gltf", bytes)); }

void FuzzGlb(std::string_view bytes) { ReadModel(SharedFolder().Write("fuzz.glb", bytes)); }

}  // namespace nacre
