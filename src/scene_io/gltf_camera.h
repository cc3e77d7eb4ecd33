// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_camera.h: the cameras of a glTF file.
#pragma once

#include <cstddef>
#include <optional>

#include "base/vec.h"
#include "scene/scene.h"
#include "scene_io/gltf_document.h"

namespace nacre {

// Transforms a direction of a node to the world by the node's matrix (row vectors). The result has
// unit length, or is zero where the matrix maps the direction to zero or is not finite.
Vec3d GltfDirection(const Imath::M44d& world_from_node, const Vec3d& direction);

// The camera of the file with the index `camera`, placed by the node `index`, whose matrix (row
// vectors) is given. Throws Error (kBadInput) for a camera that does not exist or has no view.
// Returns none, with a warning, where the matrix maps the view direction to zero. Clipping planes
// are ignored: nothing is clipped.
std::optional<Camera> MakeGltfCamera(int camera, size_t index, const Imath::M44d& world_from_node,
                                     GltfDocument* document);

}  // namespace nacre
