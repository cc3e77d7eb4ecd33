// SPDX-License-Identifier: Apache-2.0
// render/sampled_lights.h: what a batch of hits reflects of lights with an extent.
#pragma once

#include "render/plan.h"
#include "render/stage_clock.h"
#include "sampling/pair_sampler.h"
#include "shading/sampled_light.h"

namespace nacre {

struct TileScratch;

// Buffers for it.
struct SampledScratch {
  SampleNumbers numbers{kBatchCapacity};  // of the batch's samples
  UnitPoints points{kBatchCapacity};
  LightDirections directions;
  AlignedArray<float> density{kBatchCapacity}, weight{kBatchCapacity};
  AlignedArray<uint8_t> flat{kBatchCapacity};  // 1: a hit's diffuse part is in closed form
  ReflectedRadiance unit;                      // of a light of colour 1
  RayBatch sky_rays;                           // through the samples, where a sky is seen
  Soa3<float> sky;                             // what they see of it
};

// Adds the reflection of every light of plan.sampled_lights to scratch->total, and to the layers
// of lights that have one. Hits are sorted into runs, PrepareRun has run, and
// scratch->sampled->numbers are those of the samples.
void ShadeBySampledLights(const RenderPlan& plan, TileScratch* scratch, StageClock* clock,
                          RenderStats* stats);

}  // namespace nacre
