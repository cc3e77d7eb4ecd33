// SPDX-License-Identifier: Apache-2.0
// shading/reflection.h: the light that a surface reflects from one light to one viewer, in double.
#pragma once

#include "base/vec.h"

namespace nacre {

// Radiance towards the viewer per irradiance perpendicular to the light, f n.l. It is finite for
// every model, even where the BRDF f is not.
struct Reflection {
  Rgb diffuse{0, 0, 0}, specular{0, 0, 0};

  Rgb Sum() const { return diffuse + specular; }
};

}  // namespace nacre
