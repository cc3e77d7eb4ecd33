// SPDX-License-Identifier: Apache-2.0
// compare/ssim.h: the structural similarity of two grey pictures.
#pragma once

#include "compare/plane.h"

namespace nacre {

// Wang, Bovik, Sheikh and Simoncelli 2004, "Image Quality Assessment: From Error Visibility to
// Structural Similarity": the window and constants of their section III-C, for greys in [0, 1].
inline constexpr int kSsimRadius = 5;  // 11x11
inline constexpr double kSsimSigma = 1.5;
inline constexpr double kSsimC1 = 0.01 * 0.01;
inline constexpr double kSsimC2 = 0.03 * 0.03;

// Their eq. 13 at every pixel whose window lies within the picture, which so loses kSsimRadius on
// each side: theirs is not defined beyond. Both must have one size, of at least 11x11.
Plane SsimMap(const Plane& a, const Plane& b);

// The mean of the map, eq. 17. 1 for equal pictures, and at most that.
double Ssim(const Plane& a, const Plane& b);

}  // namespace nacre
