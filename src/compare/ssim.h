// SPDX-License-Identifier: Apache-2.0
// compare/ssim.h: the structural similarity of two grey pictures, and its steps on rows of pixels,
// whose kernels are in ssim_rows_kernel.cc.
#pragma once

#include <cstddef>
#include <functional>

#include "compare/plane.h"

namespace nacre {

// Wang, Bovik, Sheikh and Simoncelli 2004, "Image Quality Assessment: From Error Visibility to
// Structural Similarity": the window and constants of their section III-C, for greys in [0, 1].
inline constexpr int kSsimRadius = 5;  // 11x11
inline constexpr double kSsimSigma = 1.5;
inline constexpr double kSsimC1 = 0.01 * 0.01;
inline constexpr double kSsimC2 = 0.03 * 0.03;

// Writes the grey values of row `y`. Must be thread-safe.
using GreyRows = std::function<void(int y, float* greys)>;

// The encoded grey of the light's luminance, as sent to a display: the 8-bit greys for which SSIM
// was designed are encoded, too. Keeps references to its arguments.
GreyRows ShownGreys(const PictureView& picture, const ShowFunction& show);

// The mean SSIM (eq. 13 of Wang et al.), summed in double, over all pixels whose window lies within
// the picture, beyond which it is not defined. At most 1, the value for equal pictures. Both
// pictures have the same size, of at least 11x11.
double Ssim(int width, int height, const GreyRows& a, const GreyRows& b);

// ---- Rows ---------------------------------------------------------------------------------------

// sRGB greys of the luminance of linear light, within 5e-7. All arrays are padded to whole vectors.
void EncodeGreys(size_t count, const float* r, const float* g, const float* b, float* greys);

// The number of doubles that SsimRowSum needs as scratch, for rows of `width` pixels.
size_t SsimScratch(size_t width);

// The sum of SSIM over all windows in kernel.size() rows of each picture. `kernel` is one dimension
// of the window, and symmetric. Rows are padded to whole vectors.
double SsimRowSum(const Kernel& kernel, size_t width, const float* const* a, const float* const* b,
                  double* scratch);

}  // namespace nacre
