// SPDX-License-Identifier: Apache-2.0
// compare/flip.h: FLIP, what a viewer who flips between two pictures sees change: Andersson,
// Nilsson, Akenine-Moeller, Oskarsson, Astroem and Fairchild 2020, "FLIP: A Difference Evaluator
// for Alternating Images".
#pragma once

#include <span>

#include "compare/picture_view.h"
#include "compare/plane.h"

namespace nacre {

// Pixels per degree of vision of a display of 3840 pixels on 0.7 m, seen from 0.7 m. As theirs, of
// the degree straight ahead: distance pixels / width pi / 180.
inline constexpr double kDefaultPixelsPerDegree = 67.020643276582255;

// FLIP in [0, 1] of each pixel, the largest over all ways in which the pictures are shown; 0: no
// difference. Equal if the pictures change places. Both must have one size, of any number of
// pixels.
//
// In float; tests/compare/flip_twin.h is the same in double. The mean is within 1e-6 of that. A
// pixel is within 1e-4, but for those with a strong feature and hardly any difference of colour:
// float rounds colours by 3e-5 of the 100 of L*, which makes a colour's error of 4e-5 out of 0, and
// the feature takes a root of it. They are within 1e-3. Pixels are exactly 0 where all that the
// filters look at is equal.
Plane FlipMap(const PictureView& reference, const PictureView& test,
              std::span<const ShowPair> shows, double pixels_per_degree);

}  // namespace nacre
