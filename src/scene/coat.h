// SPDX-License-Identifier: Apache-2.0
// scene/coat.h: the clear coats of a material as materials of their own.
#pragma once

#include <string_view>
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
  // How the coat, at the strength that it has, colours the light from below that it does not
  // reflect, in [0, 1]. Where a map of its strength leaves less of the coat, it colours less.
  Rgb tint;
  std::string_view roughness;  // the name of the parameter that is its roughness
};

// Returns the coats of `material` from the bottom up. What lies below a coat gets the share of the
// light that the coat's albedo leaves, times its tint. Of all models, metallic_roughness has coats.
std::vector<Coat> CoatsOf(const Material& material);

// Removes the coats from a material. Returns whether it had any.
bool RemoveCoats(Material* material);

}  // namespace nacre
