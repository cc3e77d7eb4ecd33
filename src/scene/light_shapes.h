// SPDX-License-Identifier: Apache-2.0
// scene/light_shapes.h: area lights as shapes, for the camera to see and to block other light.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene/scene.h"

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

// Primitives [begin, end), as Scene numbers them: spheres first, then the meshes' triangles.
struct PrimitiveRange {
  uint32_t begin = 0, end = 0;

  bool Contains(uint32_t primitive) const { return primitive >= begin && primitive < end; }
};

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
