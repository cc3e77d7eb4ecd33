// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_meshes.h: the triangles of a glTF file.
#pragma once

#include <vector>

#include "base/vec.h"
#include "scene/scene.h"
#include "scene_io/gltf_document.h"
#include "scene_io/scene_budget.h"

namespace nacre {

// Adds the primitives of a mesh that have triangles, in the world. `name` is the node's. `joints`,
// those of the node's skin (gltf_skins.h), place meshes in the stead of its matrix; null: it has
// none. Throws Error (kBadInput) for accessors that are not there, too short or of another type,
// indices out of range, positions that are not finite or leave the range of coordinates.
void AddGltfMesh(int mesh, const std::string& name, const Imath::M44d& world_from_node,
                 const std::vector<Imath::M44d>* joints, GltfDocument* document,
                 SceneBudget* budget, Scene* scene);

}  // namespace nacre
