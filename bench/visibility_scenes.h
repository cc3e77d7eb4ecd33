// SPDX-License-Identifier: Apache-2.0
// bench/visibility_scenes.h: the sphere scenes that nacre and the bare Embree baseline both trace.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace nacre {

inline constexpr int kFrameWidth = 1920;
inline constexpr int kFrameHeight = 1080;

// What the benchmarks' names call a scene, and the spheres along one side of its square grid:
// "grid" is scenes/material_grid.json (side 0).
struct SphereScene {
  const char* name;
  int side;
};

const std::vector<SphereScene>& SphereScenes();
Scene MakeSphereScene(const SphereScene& which);

}  // namespace nacre
