// SPDX-License-Identifier: Apache-2.0
// scene_io/materialx.h: materials of MaterialX documents (.mtlx), in the form of scene files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene_io/json_text.h"
#include "scene_io/materialx_material.h"
#include "scene_io/text_file.h"

namespace nacre {

// Whether the file is a MaterialX document, by its extension.
bool IsMaterialXFile(const std::string& file);

// Reads the material `name` of the document `file`: a <surfacematerial>, or what a look assigns to
// the geometry of this name. An empty name is that of the only material. open_pbr_surface and
// standard_surface become the model open_pbr, gltf_pbr becomes metallic_roughness
// (materialx_shaders.h). The document, what it includes and its images are resolved in `folder` by
// the rules. Throws Error (kBadInput), with file and line, for whatever is malformed; parameters
// and nodes that nacre does not have are told in `notes`.
MaterialXMaterial ReadMaterialX(const std::filesystem::path& folder, const std::string& file,
                                const std::string& name, const ReferenceRules& rules);

// A material on the command line: "x.mtlx", or "x.mtlx#name". Returns an object as in scene files,
// with the file and the name of the material, its model, and its name as "name", which labels it.
Json MaterialXReference(const std::string& text);
bool IsMaterialXReference(const std::string& text);

// The files of all materials in the JSON that come from MaterialX documents: {"file": "x.mtlx"}.
std::vector<std::filesystem::path> MaterialXFilesIn(const Json& json);

}  // namespace nacre
