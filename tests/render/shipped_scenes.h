// SPDX-License-Identifier: Apache-2.0
// tests/render/shipped_scenes.h: every scene that ships, small.
#pragma once

#include <filesystem>
#include <string>

#include "catch.h"
#include "scene_io/load_scene.h"

namespace nacre {

// Calls body(scene) with each, of 96x54 pixels and one sample.
template <class Body>
void ForEachShippedScene(const Body& body) {
  namespace fs = std::filesystem;
  for (const fs::directory_entry& entry :
       fs::recursive_directory_iterator(fs::path(NACRE_SOURCE_DIR) / "scenes")) {
    const fs::path& path = entry.path();
    if (path.extension() != ".json" || path.filename() == "nacre.schema.json") continue;
    CAPTURE(path.string());
    LoadOptions options{
        .overrides = {{"/image/width", "96"}, {"/image/height", "54"}, {"/image/spp", "1"}}};
    if (path.filename() == "million_spheres.json") {
      options.overrides.emplace_back("/shapes/1/count", "3000");
    }
    body(LoadScene(path.string(), options));
  }
}

}  // namespace nacre
