// SPDX-License-Identifier: Apache-2.0
// visibility/trace_sphere.h: a sphere as the hit tests read it, relative to the camera.
#pragma once

#include "base/vec.h"

namespace nacre {

// The relative rounding error of one operation on floats.
inline constexpr double kFloatUnit = 0x1p-24;

struct TraceSphere {
  Vec3d center;
  double radius = 0;
};

inline bool Coincide(const TraceSphere& a, const TraceSphere& b) {
  return a.center == b.center && a.radius == b.radius;
}

}  // namespace nacre
