// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_camera.h: the cameras of a glTF file.
#pragma once

#include <cstddef>
#include <optional>

#include "base/vec.h"
#include "scene/scene.h"
#include "scene_io/gltf_document.h"

namespace nacre {

// A direction of a node in the world, by its matrix (row vectors): of unit length, or zero where
// the matrix leaves nothing of it or is not finite.
Vec3d GltfDirection(const Imath::M44d& world_from_node, const Vec3d& direction);

// The file's camera, as the node `index` with this matrix (row vectors) has it. Throws Error
// (kBadInput) for one that is not there or has no view. None, with a warning, where the matrix
// leaves no direction. Clipping planes are left out: nothing is clipped.
std::optional<Camera> MakeGltfCamera(int camera, size_t index, const Imath::M44d& world_from_node,
                                     GltfDocument* document);

}  // namespace nacre
