// SPDX-License-Identifier: Apache-2.0
// render/sampled_lights.h: computes the light that a batch of hits reflects from lights with an
// extent.
#pragma once

#include "render/direct_batch.h"
#include "sampling/pair_sampler.h"

namespace nacre {

// Adds the reflected light of the plan's sampled lights to the batch's radiance. `numbers` are
// those of the batch's samples.
void ShadeBySampledLights(const DirectBatch& batch, const SampleNumbers& numbers);

}  // namespace nacre
