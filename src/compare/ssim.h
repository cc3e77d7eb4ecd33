// SPDX-License-Identifier: Apache-2.0
// compare/ssim.h: the structural similarity of two grey pictures.
#pragma once

#include <cstddef>
#include <functional>

#include "compare/picture_view.h"

namespace nacre {

// Wang, Bovik, Sheikh and Simoncelli 2004, "Image Quality Assessment: From Error Visibility to
// Structural Similarity": the window and constants of their section III-C, for greys in [0, 1].
inline constexpr int kSsimRadius = 5;  // 11x11
inline constexpr double kSsimSigma = 1.5;
inline constexpr double kSsimC1 = 0.01 * 0.01;
inline constexpr double kSsimC2 = 0.03 * 0.03;

// Writes the greys of row `y`. Any thread.
using GreyRows = std::function<void(int y, float* greys)>;

// The grey that a display is given for the luminance of the light: the greys of 8-bit pictures,
// which SSIM was made for, are encoded too. Keeps references to its arguments.
GreyRows ShownGreys(const PictureView& picture, const ShowFunction& show);

// The mean of their eq. 13, summed in double, over every pixel whose window lies within the
// picture: theirs is not defined beyond. 1 for equal pictures, and at most that. Both have one
// size, of at least 11x11.
double Ssim(int width, int height, const GreyRows& a, const GreyRows& b);

}  // namespace nacre
