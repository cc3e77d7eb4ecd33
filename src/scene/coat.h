// SPDX-License-Identifier: Apache-2.0
// scene/coat.h: the clear coats of a material as materials of their own.
#pragma once

#include <vector>

#include "scene/material.h"

namespace nacre {

// A material has at most this many coats.
inline constexpr size_t kMostCoats = 4;

// A coat over a material.
struct Coat {
  // metallic_roughness with a black base and a dielectric highlight, whose weight `specular` is the
  // strength of the coat, and with the coat's own roughness and normal map.
  Material material;
  // How a coat colours the light from below that it does not reflect, in [0, 1].
  Rgb tint{1, 1, 1};
};

// Returns the clear coats of `material` from the bottom up. What lies below a coat gets the share
// of the light that the coat's albedo leaves, times its tint. Only metallic_roughness has a coat
// today, and one at most, which is clear.
std::vector<Coat> CoatsOf(const Material& material);

// Removes the coats from a material. Returns whether it had any.
bool RemoveCoats(Material* material);

}  // namespace nacre
