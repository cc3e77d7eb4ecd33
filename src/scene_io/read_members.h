// SPDX-License-Identifier: Apache-2.0
// scene_io/read_members.h: what has been read of a scene file, for reading some of it again.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "scene/handle.h"
#include "scene/scene.h"
#include "scene_io/texture_image.h"

namespace nacre {

// A texture of the file. One that says nothing of its encoding is sRGB where it is a colour and
// linear where it is data, and read for its alpha where it is an opacity: up to three of the
// scene's textures, read when first used.
struct TextureSource {
  Texture texture;  // all but the image
  std::string file, part;
  bool is_readable = false;  // false: its faults have been reported
  std::optional<TextureEncoding> encoding;
  std::array<TextureId, 3> decoded{};  // by encoding
};

using MaterialNames = std::unordered_map<std::string, MaterialId>;
using WholeMaterials = std::unordered_map<uint32_t, Material>;          // by place in the scene
using TextureSources = std::unordered_map<std::string, TextureSource>;  // by name

// How many a scene has of what shapes make.
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

// What a shape has made: so many, from these places of the scene on.
struct ShapeRead {
  ShapeCounts first, made;
};

// What was read of the file that other parts refer to, and where in the scene its items are.
struct ReadMembers {
  bool current = false;  // false: out of step with the scene; the next change reads all
  size_t materials = 0;  // made of the member "materials", in its order; those of shapes follow
  size_t textures = 0;   // that these name
  size_t images = 0;     // of these
  MaterialNames names;
  TextureSources sources;
  std::unordered_set<uint32_t> varied;  // materials that shapes have made others of
  WholeMaterials whole;                 // as they were read, those whose idle layers are gone
  std::vector<ShapeRead> shapes;        // those of SceneTree::root, in their order
  std::vector<size_t> runs;             // of SceneTree::spheres: the first sphere of each run
};

}  // namespace nacre
