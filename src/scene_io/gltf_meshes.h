// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_meshes.h: the triangles of a glTF file.
#pragma once

#include <vector>

#include "base/vec.h"
#include "scene/scene.h"
#include "scene_io/gltf_document.h"
#include "scene_io/scene_budget.h"

namespace nacre {

// Adds the primitives of a mesh that have triangles, in world space. `name` is the node's name.
// `joints` has the matrices of the node's skin (gltf_skins.h), which then place the vertices
// instead of the node's matrix; null if the node has no skin. Throws Error (kBadInput) for
// accessors that do not exist, are too short or of another type, indices out of range, and
// positions that are not finite or out of the range of coordinates.
void AddGltfMesh(int mesh, const std::string& name, const Imath::M44d& world_from_node,
                 const std::vector<Imath::M44d>* joints, GltfDocument* document,
                 SceneBudget* budget, Scene* scene);

}  // namespace nacre
