// SPDX-License-Identifier: Apache-2.0
// tests/fuzz/scene_json_fuzz.cc: the text of a scene file.
#include "fuzz/fuzz_input.h"
#include "fuzz/targets.h"
#include "scene/hash.h"

namespace nacre {

void FuzzSceneJson(std::string_view bytes) {
  ReadOrRefuse([&] {
    const Scene scene = LoadSceneText(bytes, "scene.json", SharedFolder().path(), SmallScenes());
    HashScene(scene);  // walks all of it
  });
}

}  // namespace nacre
