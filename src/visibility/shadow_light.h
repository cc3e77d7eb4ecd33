// SPDX-License-Identifier: Apache-2.0
// visibility/shadow_light.h: a light as shadow rays go to it.
#pragma once

#include "base/vec.h"
#include "scene/light.h"

namespace nacre {

struct ShadowLight {
  bool positional = false;
  Vec3d place{0, 0, 1};  // its position relative to the camera; else the unit direction towards it
};

// `light` is punctual.
ShadowLight MakeShadowLight(const Light& light, const Vec3d& camera_position);

// How much larger a sphere is taken than it is wherever only bounds are asked for: far more than
// what the roundings of rays, of the exact test and of the bound itself can amount to. All of them
// are a few 2^-53 of the radius or of one of the coordinates, of which `reach` is an upper bound.
inline double BoundMargin(double radius, double reach) { return 1e-9 * radius + 1e-12 * reach; }

}  // namespace nacre
