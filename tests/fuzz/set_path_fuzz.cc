// SPDX-License-Identifier: Apache-2.0
// tests/fuzz/set_path_fuzz.cc: what follows --set, on a scene and on a model.
#include <algorithm>

#include "fuzz/fuzz_input.h"
#include "fuzz/targets.h"

namespace nacre {
namespace {

constexpr std::string_view kScene = R"({"nacre": 1, "image": {"width": 8, "height": 8},
  "materials": {"a": {"model": "metallic_roughness"}, "b/~": {"model": "phong"}},
  "lights": {"key": {"type": "point", "position": [0, 2, 2], "intensity": 5}},
  "shapes": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "a"},
             {"type": "grid", "material": "b/~", "rows": {"count": 2}}]})";

}  // namespace

void FuzzSetPath(std::string_view bytes) {
  LoadOptions options = SmallScenes();
  while (!bytes.empty()) {
    const std::string_view line = bytes.substr(0, bytes.find('\n'));
    bytes.remove_prefix(std::min(line.size() + 1, bytes.size()));
    const size_t equal = line.find('=');  // as the command line parts them
    if (equal == std::string_view::npos) continue;
    options.overrides.emplace_back(line.substr(0, equal), line.substr(equal + 1));
  }
  ReadOrRefuse([&] { LoadSceneText(kScene, "scene.json", SharedFolder().path(), options); });
  ReadOrRefuse([&] { LoadScene(SharedFolder().path() / "mesh.ply", options); });
}

}  // namespace nacre
