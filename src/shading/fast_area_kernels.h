// SPDX-License-Identifier: Apache-2.0
// shading/fast_area_kernels.h: the SIMD kernels behind fast_area.h: the parts of lobes that lights
// fill, on hits [begin, end).
#pragma once

#include "light/ltc.h"
#include "shading/fast_area.h"

namespace nacre {

// Of rectangles and meshes.
void FlatShares(const LtcRows& rows, const SampledLight& light, const LobeRange& range,
                LobeShares* shares);
// Of disks and spheres.
void RoundShares(const LtcRows& rows, const SampledLight& light, const LobeRange& range,
                 LobeShares* shares);

}  // namespace nacre
