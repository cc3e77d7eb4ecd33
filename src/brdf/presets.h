// SPDX-License-Identifier: Apache-2.0
// brdf/presets.h: measured indices of refraction of named materials, for the exact Fresnel curves.
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace nacre {

enum class InterfaceKind { kConductor, kDielectric };

// eta + i k for the red, green and blue of linear Rec. 709; k = 0 for dielectrics.
struct IndexPreset {
  std::string_view name;
  InterfaceKind kind;
  std::array<double, 3> eta;
  std::array<double, 3> k;
};

std::span<const IndexPreset> IndexPresets();

// The preset of this name, or null.
const IndexPreset* FindIndexPreset(std::string_view name);

}  // namespace nacre
