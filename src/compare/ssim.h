// SPDX-License-Identifier: Apache-2.0
// compare/ssim.h: the structural similarity of two grey pictures.
#pragma once

#include <cstddef>
#include <functional>

#include "compare/picture_view.h"

namespace nacre {

// Writes the grey values of row `y`. Must be thread-safe.
using GreyRows = std::function<void(int y, float* greys)>;

// The encoded grey of the light's luminance, as sent to a display: the 8-bit greys for which SSIM
// was designed are encoded, too. Keeps references to its arguments.
GreyRows ShownGreys(const PictureView& picture, const ShowFunction& show);

// The mean SSIM (eq. 13 of Wang et al.), summed in double, over all pixels whose window lies within
// the picture, beyond which it is not defined. At most 1, the value for equal pictures. Both
// pictures have the same size, of at least 11x11.
double Ssim(int width, int height, const GreyRows& a, const GreyRows& b);

}  // namespace nacre
