// SPDX-License-Identifier: Apache-2.0
// scene_io/obj_materials.h: converts the material libraries (MTL) of Wavefront OBJ files.
#pragma once

#include <filesystem>
#include <vector>

#include "scene/scene.h"
#include "scene_io/load_options.h"
#include "scene_io/obj_file.h"

namespace nacre {

// Adds the materials of the libraries that the OBJ file `path` names, with unique names, and after
// them one for faces without a material; their textures and images are added to the scene, too.
// Returns the material for each of obj.material_names, followed by the one for faces without a
// material.
//
// Materials are Blinn-Phong in the classic convention, as the format defines them (its H is the
// bisector of L and V), or metallic-roughness where the library gives them a roughness or a
// metallic (Pr, Pm and their images).
//
// Warns (options.on_warning) of libraries and images that are missing, images that cannot be read,
// names that no library has, numbers out of range and what is not shown. Throws Error (kBadInput)
// for libraries and images outside the folder, more than kMaxModelMaterials materials or more
// texels than TexelBudget allows, and for numbers that are malformed or not finite.
std::vector<MaterialId> AddObjMaterials(const std::filesystem::path& path, const ObjFile& obj,
                                        const LoadOptions& options, Scene* scene);

// The material of models without any: a light grey that is neither matt nor glossy.
Material MakeClay();

}  // namespace nacre
