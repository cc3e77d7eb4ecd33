// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_meshes.h: the triangles of a glTF file.
#pragma once

#include "base/vec.h"
#include "scene/scene.h"
#include "scene_io/gltf_document.h"

namespace nacre {

// How much more may be made of a file, whose nodes can use the same mesh many times.
struct GltfBudget {
  uint64_t max_triangles = 100'000'000;
  uint64_t corners_left = 3 * max_triangles;
};

// Adds the primitives of a mesh that have triangles, in the world. `name` is the node's. Throws
// Error (kBadInput) for accessors that are not there, too short or of another type, indices out of
// range, positions that are not finite or leave the range of coordinates.
void AddGltfMesh(int mesh, const std::string& name, const Imath::M44d& world_from_node,
                 GltfDocument* document, GltfBudget* budget, Scene* scene);

}  // namespace nacre
