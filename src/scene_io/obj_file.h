// SPDX-License-Identifier: Apache-2.0
// scene_io/obj_file.h: the statements of a Wavefront OBJ file that say what its polygons are.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/vec.h"

namespace nacre {

struct ObjCorner {
  uint32_t position = 0;
  int32_t uv = -1, normal = -1;  // below 0: none
};

// All indices are within range.
struct ObjFile {
  std::vector<Vec3d> positions;  // NaN where the file says so
  std::vector<Vec3f> colors;     // linear, one per position; empty: the file has none
  std::vector<Vec3d> normals;
  std::vector<Vec2d> uvs;

  std::vector<uint16_t> corner_counts;  // of each face, at least 3
  std::vector<ObjCorner> corners;       // of all faces, one after the other

  // What is said of the faces from `first_face` on.
  struct Use {
    size_t first_face;
    uint32_t name;  // in material_names; or a number of a smoothing group, kSmoothingOff for none
  };
  static constexpr uint32_t kSmoothingOff = 0;
  std::vector<Use> uses;       // materials; faces before the first have none
  std::vector<Use> smoothing;  // groups ("s"), off before the first; empty: the file has none
  std::vector<std::string> material_names;  // each once
  std::vector<std::string> libraries;       // what follows "mtllib", each once
};

// Calls use(material, group, corners, count) for each face whose positions are all numbers: the
// material is a place in obj.material_names, or kNoMaterial, the group one of smoothing.
constexpr uint32_t kNoMaterial = 0xffffffffu;
template <class Corner, class Use>
void ForEachFace(const ObjFile& obj, Corner* corners, const Use& use) {
  auto next = obj.uses.begin();
  auto next_group = obj.smoothing.begin();
  uint32_t material = kNoMaterial, group = ObjFile::kSmoothingOff;
  for (size_t face = 0; face < obj.corner_counts.size(); ++face) {
    const size_t count = obj.corner_counts[face];
    if (next != obj.uses.end() && next->first_face == face) material = (next++)->name;
    if (next_group != obj.smoothing.end() && next_group->first_face == face) {
      group = (next_group++)->name;
    }
    const bool is_placed = std::all_of(corners, corners + count, [&](const ObjCorner& corner) {
      return !std::isnan(obj.positions[corner.position].x);
    });
    if (is_placed) use(material, group, corners, count);
    corners += count;
  }
}

// Numbers in colours (v x y z r g b) are decoded as sRGB, as the programs that write them do;
// colours with a number above 1 are in [0, 255]. What other readers put up with is read, and
// reported to `warn`, each kind once, unless that is empty: indices of uvs and normals that the
// file does not have, or of 0, stand for none; faces of fewer than three corners are left out;
// positions that are no numbers (nan, inf, 1.#QNAN) are NaN, normals 0 and uvs 0. So is what is not
// read: lines, points, free-form curves and surfaces.
// It is read in pieces, on up to `threads` threads (0: as many as the machine has).
// Throws Error (kBadInput) with the file and the line for words in the place of numbers, positions
// that the file does not have, faces of more than 65 535 corners, and files without faces.
ObjFile ReadObjFile(const std::filesystem::path& path, int threads,
                    const std::function<void(const std::string&)>& warn);

}  // namespace nacre
