// SPDX-License-Identifier: Apache-2.0
#include "visibility/shadow_light.h"

#include <variant>

namespace nacre {

ShadowLight MakeShadowLight(const Light& light, const Vec3d& camera_position) {
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
