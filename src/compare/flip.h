// SPDX-License-Identifier: Apache-2.0
// compare/flip.h: FLIP, what a viewer who flips between two pictures sees change: Andersson,
// Nilsson, Akenine-Moeller, Oskarsson, Astroem and Fairchild 2020, "FLIP: A Difference Evaluator
// for Alternating Images".
#pragma once

#include "compare/plane.h"

namespace nacre {

// Pixels per degree of vision of a display of 3840 pixels on 0.7 m, seen from 0.7 m. As theirs, of
// the degree straight ahead: distance pixels / width pi / 180.
inline constexpr double kDefaultPixelsPerDegree = 67.020643276582255;

// FLIP in [0, 1] of each pixel; 0: no difference. Linear display light in [0, 1], sRGB primaries.
// Equal if the pictures change places. Both must have one size, of any number of pixels.
Plane FlipMap(const Planes& reference, const Planes& test, double pixels_per_degree);

}  // namespace nacre
