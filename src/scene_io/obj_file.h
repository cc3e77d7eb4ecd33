// SPDX-License-Identifier: Apache-2.0
// scene_io/obj_file.h: the statements of a Wavefront OBJ file that define its polygons.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/vec.h"

namespace nacre {

struct ObjCorner {
  uint32_t position = 0;
  int32_t uv = -1, normal = -1;  // below 0: none
};

// The polygons of a file. All indices are within range.
struct ObjFile {
  std::vector<Vec3d> positions;  // NaN where the file has no number
  std::vector<Vec3f> colors;     // linear, one per position; empty: the file has no colours
  std::vector<Vec3d> normals;
  std::vector<Vec2d> uvs;

  std::vector<uint16_t> corner_counts;  // the number of corners of each face, at least 3
  std::vector<ObjCorner> corners;       // the corners of all faces, one face after the other

  // What applies to the faces from `first_face` on.
  struct Use {
    size_t first_face;
    uint32_t name;  // index into material_names; or number of a smoothing group, kSmoothingOff for
                    // none
  };
  static constexpr uint32_t kSmoothingOff = 0;
  std::vector<Use> uses;       // materials; faces before the first have none
  std::vector<Use> smoothing;  // groups ("s"); off before the first; empty: the file has none
  std::vector<std::string> material_names;  // each once
  std::vector<std::string> libraries;       // what follows "mtllib", each once
};

// A face: `material` is an index into ObjFile::material_names, or kNoMaterial, and `group` a
// smoothing group.
constexpr uint32_t kNoMaterial = 0xffffffffu;
template <class Corner>
struct ObjFace {
  uint32_t material, group;
  std::span<Corner> corners;
};

// Calls use(face) for each face whose positions are all finite. The corners of a file that is not
// const may be changed.
template <class File, class Use>
void ForEachFace(File& obj, const Use& use) {
  auto next = obj.uses.begin();
  auto next_group = obj.smoothing.begin();
  uint32_t material = kNoMaterial, group = ObjFile::kSmoothingOff;
  auto* first = obj.corners.data();
  using Corner = std::remove_pointer_t<decltype(first)>;
  for (size_t face = 0; face < obj.corner_counts.size(); ++face) {
    const std::span<Corner> corners(first, obj.corner_counts[face]);
    if (next != obj.uses.end() && next->first_face == face) material = (next++)->name;
    if (next_group != obj.smoothing.end() && next_group->first_face == face) {
      group = (next_group++)->name;
    }
    const bool is_placed = std::all_of(
        corners.begin(), corners.end(),
        [&](const ObjCorner& corner) { return !std::isnan(obj.positions[corner.position].x); });
    if (is_placed) use(ObjFace<Corner>{material, group, corners});
    first += corners.size();
  }
}

// Reads an OBJ file in pieces, on up to `threads` threads (0: as many as the machine has).
//
// Vertex colours (v x y z r g b) are decoded as sRGB, which is what the programs that write them
// use; colours with a component above 1 are taken as [0, 255]. Defects that other readers tolerate
// are read, and reported to `warn` (each kind once, unless it is empty): indices of uvs and normals
// that the file does not have, and indices of 0, mean none; faces of fewer than three corners are
// left out; where the file writes a NaN or infinity (nan, inf, 1.#QNAN), positions become NaN,
// normals and uvs 0. Statements that are not read are reported as well: lines, points, free-form
// curves and surfaces.
// Throws Error (kBadInput) with the file and the line for words in the place of numbers, positions
// that the file does not have, faces of more than 65 535 corners, and files without faces.
ObjFile ReadObjFile(const std::filesystem::path& path, int threads,
                    const std::function<void(const std::string&)>& warn);

}  // namespace nacre
