// SPDX-License-Identifier: Apache-2.0
// scene/idle_layers.h: removes coats, sheen and emission that are known to contribute nothing.
#pragma once

#include <optional>

#include "scene/scene.h"

namespace nacre {

// Removes each coat, sheen and emission, with its maps, whose factor is 0 or whose map is black: it
// would cost time and change no bit. Returns the original material, or nullopt if nothing was
// removed.
std::optional<Material> RemoveIdleLayers(const Scene& scene, Material* material);

}  // namespace nacre
