// SPDX-License-Identifier: Apache-2.0
// scene/light_shapes.h: where area lights are.
#pragma once

#include <optional>
#include <vector>

#include "base/vec.h"
#include "scene/light.h"

namespace nacre {

// The corners of a rectangle light, counter-clockwise as seen from the side that emits: the first
// one and the edges from it.
struct RectangleCorners {
  Vec3d corner, edge_x, edge_y;  // edge_x x edge_y points to the side that emits
};
RectangleCorners CornersOf(const RectangleAreaLight& light);

// Two unit vectors perpendicular to each other and to `normal`, which need not be a unit vector.
void MakeTangents(const Vec3d& normal, Vec3d* tangent_x, Vec3d* tangent_y);

struct LightBall {
  Vec3d center;
  double radius;
};
// A ball around the positions of a mesh, of which there is at least one.
LightBall BallAround(const std::vector<Vec3d>& positions);
// A ball around an area light; nullopt if the light is not a visible surface.
std::optional<LightBall> VisibleBall(const Light& light);

}  // namespace nacre
