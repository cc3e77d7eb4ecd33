// SPDX-License-Identifier: Apache-2.0
// scene/idle_layers.h: removes the maps of layers that are known to contribute nothing.
#pragma once

#include <optional>

#include "scene/scene.h"

namespace nacre {

// Removes the maps of each layer, such as a coat, sheen or emission, of which a parameter or its
// map leaves nothing (MaterialParameter::layer): they would cost time and change no bit. A
// parameter whose map is black becomes 0. Returns the original material, or nullopt if nothing was
// removed.
std::optional<Material> RemoveIdleLayers(const Scene& scene, Material* material);

}  // namespace nacre
