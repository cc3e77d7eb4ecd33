// SPDX-License-Identifier: Apache-2.0
// scene/scene_with_lights.h: a scene with its area lights as shapes, for the camera to see and to
// block other light.
#pragma once

#include <vector>

#include "scene/primitive_range.h"
#include "scene/scene.h"

namespace nacre {

// The scene with area lights added, after its own shapes, as spheres and meshes of black, emissive
// materials: light i if shown[i]. primitives[i] are those of light i, or an empty range. A disk is
// a polygon with so many corners that its edge is off by at most 5e-6 of the radius. Flat lights
// are moved in front of surfaces in the same plane by 2^-44 of the coordinates.
struct SceneWithLights {
  Scene scene;
  std::vector<PrimitiveRange> primitives;
};
SceneWithLights AddLightShapes(const Scene& scene, const std::vector<bool>& shown);

// Copies everything but shapes and materials, which the caller copies, from `scene` to `with`. The
// lights and shapes of `scene` must be those that `with` was made from. Flat lights are moved again
// if the camera's position has changed.
void UpdateAllButShapes(const Scene& scene, SceneWithLights* with);

}  // namespace nacre
