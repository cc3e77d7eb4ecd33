// SPDX-License-Identifier: Apache-2.0
// scene/idle_layers.h: coats, sheen and emission that are known to show nothing.
#pragma once

#include <optional>

#include "scene/scene.h"

namespace nacre {

// Takes what shows nothing away from the material, with its maps: a coat, a sheen or an emission
// whose factor is 0, or whose map is black. It would cost time and change no bit. Returns the
// material as it was; nothing if it stays so.
std::optional<Material> RemoveIdleLayers(const Scene& scene, Material* material);

}  // namespace nacre
