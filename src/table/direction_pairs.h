// SPDX-License-Identifier: Apache-2.0
// table/direction_pairs.h: the pairs of directions that a table of a BRDF has rows for.
#pragma once

#include <vector>

#include "base/vec.h"

namespace nacre {

// Unit vectors that point away from the surface, whose normal is +z and whose tangent is +x.
struct DirectionPair {
  Vec3d to_light, to_view;
};

// How much |v|^2 of a unit vector may differ from 1: as much as for Brdf::Evaluate of nacre.h,
// which allows for vectors normalised in float.
inline constexpr double kUnitSquaredError = 16 * 0x1p-24;
// Vectors written with five digits differ by no more. They are normalised.
inline constexpr double kRoundedSquaredError = 1e-4;

// Angles in degrees: of light and view from the normal, and of the light about the normal,
// counted from the view.
struct DirectionGrid {
  std::vector<double> light_deg{0, 15, 30, 45, 60, 75, 85, 89};
  std::vector<double> view_deg{0, 15, 30, 45, 60, 75, 85, 89};
  std::vector<double> phi_deg{0, 45, 90, 135, 165, 175, 180};
  // Of the view about the normal, counted from the tangent. It is not 0, so that rows differ if a
  // program mixes up its axes.
  double view_phi_deg = 30;
};

// All pairs, light by light. A light along the normal has one azimuth.
std::vector<DirectionPair> PairsOf(const DirectionGrid& grid);

}  // namespace nacre
