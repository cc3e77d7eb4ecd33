// SPDX-License-Identifier: Apache-2.0
// render/light_cull.h: lights that a batch of hits surely gets nothing from: all of it faces away
// from them, or lies outside their cones. Leaving them out changes no bit. No light here ends at a
// distance.
#pragma once

#include "base/vec.h"
#include "hit/batch.h"
#include "scene/light.h"

namespace nacre {

// Where the hits of a batch are, relative to the camera, and which way they face.
struct BatchBounds {
  Vec3d center{0, 0, 0};
  double radius = 0;      // of a ball that holds all positions
  Vec3d axis{0, 0, 1};    // unit
  double spread_rad = 0;  // the largest angle between a normal and the axis
};
BatchBounds BoundHits(const HitBatch& hits, const HitDirections& directions);

// Where a light goes, relative to the camera.
struct LightReach {
  bool positional = false;
  Vec3d place{0, 0, 1};    // its position; or the unit direction towards it
  Vec3d axis{0, 0, 1};     // of a spot's cone, unit
  double cos_cutoff = -2;  // below -1: no cone
};
LightReach ReachOf(const Light& light, const Vec3d& camera_position);

// False only where every hit's irradiance from the light is 0.
bool MayReach(const LightReach& light, const BatchBounds& bounds);

// Fewer lights are not worth bounding the hits for.
inline constexpr size_t kFewestCulledLights = 4;

}  // namespace nacre
