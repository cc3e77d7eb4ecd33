// SPDX-License-Identifier: Apache-2.0
// scene_io/read_members.h: records what has been read of a scene file, so that parts can be read
// again.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "scene/handle.h"
#include "scene/scene.h"
#include "scene_io/texture_image.h"

namespace nacre {

// A texture of the file. Without an encoding of its own, it is sRGB where a material uses it as a
// colour, linear where it is data, and read for its alpha channel where it is an opacity. So it
// becomes up to three textures of the scene, each read when first used.
struct TextureSource {
  Texture texture;  // without its image
  std::string file, part;
  std::filesystem::path folder;  // in which the file is looked for
  bool is_readable = false;      // false: its faults have been reported
  std::optional<TextureEncoding> encoding;
  std::array<TextureId, 3> decoded{};  // indexed by encoding
};

using MaterialNames = std::unordered_map<std::string, MaterialId>;
using WholeMaterials = std::unordered_map<uint32_t, Material>;          // by index in the scene
using TextureSources = std::unordered_map<std::string, TextureSource>;  // by name

// The numbers of those items of a scene that shapes create.
struct ShapeCounts {
  size_t spheres = 0, meshes = 0, labels = 0, materials = 0;

  friend bool operator==(const ShapeCounts&, const ShapeCounts&) = default;
  friend ShapeCounts operator-(const ShapeCounts& a, const ShapeCounts& b) {
    return {a.spheres - b.spheres, a.meshes - b.meshes, a.labels - b.labels,
            a.materials - b.materials};
  }
};
inline ShapeCounts CountShapes(const Scene& scene) {
  return {scene.spheres.size(), scene.meshes.size(), scene.labels.size(), scene.materials.size()};
}

// What a shape has created: the numbers of items, and the index in the scene of the first of each.
struct ShapeRead {
  ShapeCounts first, made;
};

// The items of the file that other parts refer to, and their indices in the scene.
struct ReadMembers {
  bool current = false;  // false: differs from the scene; the next change reads everything
  size_t materials = 0;  // how many the member "materials" made, in its order; those of shapes
                         // follow
  size_t textures = 0;   // how many textures these name
  size_t images = 0;     // how many images these need
  MaterialNames names;
  TextureSources sources;
  std::unordered_set<uint32_t> varied;  // materials that shapes have made variants of
  WholeMaterials whole;                 // the originals of materials whose idle layers were removed
  std::vector<ShapeRead> shapes;        // for each shape in SceneTree::root, in order
  std::vector<size_t> runs;             // for each run of SceneTree::spheres, the index in the
                                        // scene of its first sphere
};

}  // namespace nacre
