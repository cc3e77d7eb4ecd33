// SPDX-License-Identifier: Apache-2.0
// visibility/shadow_light.h: the target of shadow rays to a punctual light.
#pragma once

#include "base/vec.h"
#include "scene/light.h"

namespace nacre {

struct ShadowLight {
  bool positional = false;
  Vec3d position{0, 0, 0};  // if positional, relative to the camera
  Vec3d to_light{0, 0, 1};  // if directional: the unit direction towards it
  friend bool operator==(const ShadowLight&, const ShadowLight&) = default;
};

// `light` must be punctual.
ShadowLight MakeShadowLight(const Light& light, const Vec3d& camera_position);

}  // namespace nacre
