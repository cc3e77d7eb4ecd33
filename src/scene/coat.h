// SPDX-License-Identifier: Apache-2.0
// scene/coat.h: the clear coat of a material as a surface of its own, above the material's.
#pragma once

#include <optional>

#include "scene/material.h"

namespace nacre {

// A dielectric's highlight over nothing: metallic_roughness of a black base, whose weight
// `specular` is how much coat there is. A hit is shaded by it once more, with the coat's own
// roughness and normal; what its albedo leaves is the share of the light that the material below
// shows. None for materials without a coat.
std::optional<Material> CoatOf(const Material& material);

}  // namespace nacre
