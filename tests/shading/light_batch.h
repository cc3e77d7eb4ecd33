// SPDX-License-Identifier: Apache-2.0
// tests/shading/light_batch.h: what was found out of lights.
#pragma once

#include "shading/shade.h"

namespace nacre {

// Of a light that EvaluateLight was asked about, with the roundings of kernels.
inline Vec3d DirectionToLight(const LightBatch& light, size_t i) {
  const float inverse = light.inverse_length[i];
  return {light.light_vector.x[i] * inverse, light.light_vector.y[i] * inverse,
          light.light_vector.z[i] * inverse};
}

}  // namespace nacre
