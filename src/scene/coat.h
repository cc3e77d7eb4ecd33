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
  // A black base with a dielectric highlight, whose weight, `specular` or `specular_weight`, is the
  // strength of the coat, and with the coat's own roughness and normal map. It is
  // metallic_roughness or open_pbr, as what it covers.
  Material material;
  // How a whole coat colours the light from below that it does not reflect, there and back, in
  // [0, 1].
  Rgb color{1, 1, 1};
  std::string_view roughness;  // the name of the parameter that is its roughness
};

// Returns the coats of `material` from the bottom up. What lies below a coat gets the share of the
// light that the coat's albedo leaves, times its tint. Of all models, metallic_roughness and
// open_pbr have coats.
std::vector<Coat> CoatsOf(const Material& material);

// The strength of a coat, in [0, 1].
double StrengthOf(const Material& coat);

// Removes the coats from a material. Returns whether it had any.
bool RemoveCoats(Material* material);

}  // namespace nacre
