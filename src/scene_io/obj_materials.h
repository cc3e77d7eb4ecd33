// SPDX-License-Identifier: Apache-2.0
// scene_io/obj_materials.h: the material libraries (MTL) of Wavefront OBJ files as materials.
#pragma once

#include <filesystem>
#include <vector>

#include "scene/scene.h"
#include "scene_io/load_scene.h"
#include "scene_io/obj_file.h"

namespace nacre {

// Adds the materials of the libraries that the OBJ file `path` names, with unique names, and after
// them the one of faces without any; their textures and images go to the scene, too. Returns the
// material of each of obj.material_names, and as the last one that of faces without any.
//
// Materials are Blinn-Phong in the classic reading, as the format defines them (its H is the
// bisector of L and V), or metallic-roughness where the library gives them a roughness or a
// metallic (Pr, Pm and their images).
//
// Warns (options.on_warning) of libraries and images that are missing, images that cannot be read,
// names that no library has, numbers out of range and what is not shown. Throws Error (kBadInput)
// for libraries and images outside the folder, more than kMaxModelMaterials materials or the texels
// of TexelBudget, and numbers that are none or not finite.
std::vector<MaterialId> AddObjMaterials(const std::filesystem::path& path, const ObjFile& obj,
                                        const LoadOptions& options, Scene* scene);

// What models without any material are made of: a light grey that is neither matt nor glossy.
Material MakeClay();

}  // namespace nacre
