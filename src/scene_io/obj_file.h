// SPDX-License-Identifier: Apache-2.0
// scene_io/obj_file.h: the statements of a Wavefront OBJ file that say what its polygons are.
#pragma once

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
  std::vector<Vec3d> positions;
  std::vector<Vec3f> colors;  // linear, one per position; empty: the file has none
  std::vector<Vec3d> normals;
  std::vector<Vec2d> uvs;

  std::vector<unsigned char> corner_counts;  // of each face, at least 3
  std::vector<ObjCorner> corners;            // of all faces, one after the other

  // Faces from `first_face` on have the material of this name; those before the first have none.
  struct Use {
    size_t first_face;
    uint32_t name;  // in material_names
  };
  std::vector<Use> uses;
  std::vector<std::string> material_names;  // each once
  std::vector<std::string> libraries;       // what follows "mtllib", each once
};

// Numbers in colours (v x y z r g b) are decoded as sRGB, as the programs that write them do;
// colours with a number above 1 are in [0, 255]. An index 0 of a uv or a normal, which some
// exporters write, stands for none. What is not read (lines, points, free-form curves and surfaces)
// is reported to `warn`, each kind once, unless that is empty.
// It is read in pieces, on up to `threads` threads (0: as many as the machine has).
// Throws Error (kBadInput) with the file and the line for numbers that are none or not finite,
// indices out of range, faces of fewer than 3 or more than 255 corners, and files without faces.
ObjFile ReadObjFile(const std::filesystem::path& path, int threads,
                    const std::function<void(const std::string&)>& warn);

}  // namespace nacre
