// SPDX-License-Identifier: Apache-2.0
// tests/color/tone_kernel.h: the SIMD tone operators of color/tone-inl.h over arrays, on the
// active target.
#pragma once

#include <vector>

#include "color/display.h"

namespace nacre {

// What color/display_kernel.cc encodes: exposure and tone operator on each pixel, in place.
void ToneLight(const DisplaySettings& settings, std::vector<float>* r, std::vector<float>* g,
               std::vector<float>* b);

}  // namespace nacre
