// SPDX-License-Identifier: Apache-2.0
// scene_io/obj_file.h: Wavefront OBJ files as tinyobjloader reads them, checked before and after.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <tiny_obj_loader.h>

namespace nacre {

struct ObjFile {
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
};

// `materials` reads the material libraries that the file names; null: nobody does. All indices of
// positions, normals and uvs are within range, or -1 where a corner has no normal or uv. Throws
// Error (kBadInput) as ReadObj does (obj.h), and what `materials` throws.
ObjFile ReadObjFile(const std::filesystem::path& path, tinyobj::MaterialReader* materials);

// Takes the next word off the front of `line`.
std::string_view NextObjWord(std::string_view* line);

// Throws Error (kBadInput) unless `line` begins with `fewest` finite numbers, or more up to `most`.
void CheckObjNumbers(std::string_view line, std::string_view keyword, int fewest, int most,
                     const std::string& place);

}  // namespace nacre
