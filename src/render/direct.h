// SPDX-License-Identifier: Apache-2.0
// render/direct.h: the fourth stage, an integrator of direct light: the radiance that surfaces
// reflect of light that arrives straight from lights.
#pragma once

#include "render/direct_batch.h"
#include "sampling/pair_sampler.h"

namespace nacre {

// Fills batch.radiance of the lit hits, except `sky`. `numbers` are those of the batch's samples;
// they may be null if the plan has no sampled lights.
void ShadeDirect(const DirectBatch& batch, const SampleNumbers* numbers);

// Fills radiance->sky for the camera rays through `film`, if the plan has a sky and any of the rays
// misses all shapes. `hits` is the number of rays that hit.
void ShadeSky(const DirectPlan& plan, const FilmBatch& film, size_t hits, DirectRoom* room,
              BatchRadiance* radiance);

}  // namespace nacre
