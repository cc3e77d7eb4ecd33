// SPDX-License-Identifier: Apache-2.0
// compare/ssim_rows.h: SSIM on rows of pixels. The kernels are in ssim_kernel.cc.
#pragma once

#include <cstddef>

#include "compare/plane.h"
#include "compare/ssim.h"

namespace nacre {

// sRGB greys of the luminance of linear light, within 5e-7. All arrays are padded to whole vectors.
void EncodeGreys(size_t count, const float* r, const float* g, const float* b, float* greys);

// Doubles that SsimRowSum wants, for rows of `width` pixels.
size_t SsimScratch(size_t width);

// The sum of the SSIM of all windows of kernel.size() rows of each picture. `kernel`, symmetric, is
// the window in one dimension. Rows are padded to whole vectors.
double SsimRowSum(const Kernel& kernel, size_t width, const float* const* a, const float* const* b,
                  double* scratch);

}  // namespace nacre
