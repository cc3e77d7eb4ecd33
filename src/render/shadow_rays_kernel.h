// SPDX-License-Identifier: Apache-2.0
// render/shadow_rays_kernel.h: makes shadow rays from hits to a punctual light, in SIMD.
#pragma once

#include <cstdint>

#include "hit/batch.h"
#include "shading/light.h"

namespace nacre {

// Makes rays [0, rays->count): ray r starts from hit from[r], at origin[from[r]], and goes to the
// light. Entries after them, up to a whole vector, are overwritten.
void FillShadowRays(const ShadingLight& light, const HitBatch& hits, const Soa3<double>& origin,
                    const AlignedArray<uint32_t>& from, ShadowRayBatch* rays);

}  // namespace nacre
