// SPDX-License-Identifier: Apache-2.0
// shading/light_directions.h: directions from the hits of a batch to a light with an extent.
#pragma once

#include <memory>

#include "hit/batch.h"

namespace nacre {

struct MeshLightScratch;

// One direction from each hit of a batch, and the light in that direction.
struct LightDirections {
  Soa3<float> to_light;                          // unit vectors
  AlignedArray<float> distance{kBatchCapacity};  // infinity for a sky; 0 if the light is missed
  AlignedArray<float> pdf{kBatchCapacity};  // with which SampleLight chooses to_light; 0 if never
  Soa3<float> radiance;  // if IsColored(light), as multiples of SampledLight::color
  std::shared_ptr<MeshLightScratch> mesh;  // made for the first mesh light
};

}  // namespace nacre
