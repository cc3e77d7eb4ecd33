// SPDX-License-Identifier: Apache-2.0
// render/shadow_rays_kernel.h: shadow rays from a batch's hits to a punctual light, in SIMD.
#pragma once

#include <cstdint>

#include "hit/batch.h"
#include "shading/light.h"

namespace nacre {

// Makes rays [0, rays->count): ray r goes from hit from[r], at origin[from[r]], to the light. What
// lies after them, up to a whole vector, is overwritten.
void FillShadowRays(const ShadingLight& light, const HitBatch& hits, const Soa3<double>& origin,
                    const AlignedArray<uint32_t>& from, ShadowRayBatch* rays);

}  // namespace nacre
