// SPDX-License-Identifier: Apache-2.0
// render/sampled_shadows.h: shadow rays along the directions that are chosen for lights with an
// extent.
#pragma once

#include "render/direct_batch.h"

namespace nacre {

// Takes room.light from the hits that something lies before the light for, along `directions`.
void CastSampledShadows(const DirectBatch& batch, const PlannedSampledLight& planned,
                        const LightDirections& directions);

}  // namespace nacre
