// SPDX-License-Identifier: Apache-2.0
// render/light_cull.h: finds lights that cannot illuminate any hit of a batch, because all of the
// hits face away from them or lie outside their cones. Leaving such lights out changes no bit.
// Lights are not culled by distance: none has a finite range.
#pragma once

#include "base/vec.h"
#include "hit/batch.h"
#include "scene/light.h"

namespace nacre {

// Bounds of the positions of a batch's hits, relative to the camera, and of their normals.
struct BatchBounds {
  Vec3d center{0, 0, 0};
  double radius = 0;      // of a ball around the centre that holds all positions
  Vec3d axis{0, 0, 1};    // unit
  double spread_rad = 0;  // the largest angle between a normal and the axis
};
BatchBounds BoundHits(const HitBatch& hits, const HitDirections& directions);

// The geometry of a punctual light, relative to the camera.
struct LightGeometry {
  bool positional = false;
  Vec3d position{0, 0, 1};  // its position if positional, else the unit direction to it
  Vec3d axis{0, 0, 1};      // of a spot's cone, unit
  double cos_cutoff = -2;   // below -1: no cone
};
LightGeometry GeometryOf(const Light& light, const Vec3d& camera_position);

// False only if the light's irradiance at every hit is 0.
bool MayIlluminate(const LightGeometry& light, const BatchBounds& bounds);

// With fewer lights, culling takes longer than it saves.
inline constexpr size_t kMinCulledLights = 4;

}  // namespace nacre
