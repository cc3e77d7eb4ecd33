// SPDX-License-Identifier: Apache-2.0
// scene/coat.h: the clear coat of a material as a material of its own.
#pragma once

#include <optional>

#include "scene/material.h"

namespace nacre {

// Returns the clear coat of `material`: metallic_roughness with a black base and a dielectric
// highlight, whose weight `specular` is the strength of the coat. Hits are shaded a second time
// with it, with the coat's own roughness and normal, and the material below gets the share of the
// light that the coat's albedo leaves. Returns nullopt if the material has no coat.
std::optional<Material> CoatOf(const Material& material);

}  // namespace nacre
