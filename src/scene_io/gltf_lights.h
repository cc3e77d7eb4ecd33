// SPDX-License-Identifier: Apache-2.0
// scene_io/gltf_lights.h: the lights of a glTF file (KHR_lights_punctual).
#pragma once

#include <cstddef>

#include "base/vec.h"
#include "scene/scene.h"
#include "scene_io/gltf_document.h"
#include "scene_io/unique_names.h"

namespace nacre {

// Adds a light of the file to the scene, placed by the node `index` with this matrix (row vectors),
// under a name that `names` has not returned before. Intensities are taken unchanged: lux as
// irradiance, candela as radiant intensity. A light with a direction that the matrix maps to zero
// is left out, with a warning.
void AddGltfLight(int light, size_t index, const Imath::M44d& world_from_node,
                  GltfDocument* document, UniqueNames* names, Scene* scene);

}  // namespace nacre
