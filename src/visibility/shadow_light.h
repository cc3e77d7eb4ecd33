// SPDX-License-Identifier: Apache-2.0
// visibility/shadow_light.h: the target of shadow rays to a punctual light.
#pragma once

#include <variant>

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
inline ShadowLight MakeShadowLight(const Light& light, const Vec3d& camera_position) {
  if (const auto* point = std::get_if<PointLight>(&light.kind)) {
    return {.positional = true, .position = point->position - camera_position};
  }
  if (const auto* spot = std::get_if<SpotLight>(&light.kind)) {
    return {.positional = true, .position = spot->position - camera_position};
  }
  const auto& sun = std::get<DirectionalLight>(light.kind);
  return {.to_light = -sun.direction_of_travel.normalized()};
}

}  // namespace nacre
