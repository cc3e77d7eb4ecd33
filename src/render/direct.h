// SPDX-License-Identifier: Apache-2.0
// render/direct.h: the fourth stage, an integrator: what surfaces reflect of light that comes
// straight from the lights.
#pragma once

#include "render/direct_batch.h"
#include "sampling/pair_sampler.h"

namespace nacre {

// Fills batch.radiance but for `sky`. `numbers`: of the batch's samples, or null where the plan has
// no sampled lights.
void ShadeDirect(const DirectBatch& batch, const SampleNumbers* numbers);

// Fills radiance->sky for the camera rays through `film`, if the plan has a sky and any ray of them
// hits nothing.
void SeeSky(const DirectPlan& plan, const FilmBatch& film, size_t hits, DirectRoom* room,
            BatchRadiance* radiance);

}  // namespace nacre
