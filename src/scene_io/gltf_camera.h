// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_camera.h: the cameras of a glTF file.
#pragma once

#include "base/vec.h"
#include "scene/scene.h"
#include "scene_io/gltf_document.h"

namespace nacre {

// A direction of a node in the world, by its matrix (row vectors): of unit length, or zero where
// the matrix leaves nothing of it.
Vec3d GltfDirection(const Imath::M44d& world_from_node, const Vec3d& direction);

// The file's camera, as the node with this matrix (row vectors) has it. Throws Error (kBadInput)
// for one that is not there or has no view. Clipping planes are left out: nothing is clipped.
Camera MakeGltfCamera(const GltfDocument& document, int camera, const Imath::M44d& world_from_node);

}  // namespace nacre
