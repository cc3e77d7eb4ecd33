// SPDX-License-Identifier: Apache-2.0
// render/sampled_shadows.h: shadow rays along sampled directions to lights with an extent.
#pragma once

#include "render/direct_batch.h"

namespace nacre {

// Sets the irradiance of room.light to 0 at hits for which something occludes the light along
// `directions`.
void CastSampledShadows(const DirectBatch& batch, const PlannedSampledLight& planned,
                        const LightShadows& shadows, const LightDirections& directions);

}  // namespace nacre
