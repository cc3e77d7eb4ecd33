// SPDX-License-Identifier: Apache-2.0
// render/sampled_lights.h: what a batch of hits reflects of lights with an extent.
#pragma once

#include "render/direct_batch.h"
#include "sampling/pair_sampler.h"

namespace nacre {

// Adds the reflection of every sampled light of the plan to the batch's radiance. `numbers`: of the
// batch's samples.
void ShadeBySampledLights(const DirectBatch& batch, const SampleNumbers& numbers);

}  // namespace nacre
