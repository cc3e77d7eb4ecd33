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
// Around a mesh that has positions.
LightBall BallAround(const std::vector<Vec3d>& positions);
// Around a light, if it is a visible surface.
std::optional<LightBall> VisibleBall(const Light& light);

// Primitives [begin, end), as Scene numbers them: spheres first, then the meshes' triangles.
struct PrimitiveRange {
  uint32_t begin = 0, end = 0;

  bool Contains(uint32_t primitive) const { return primitive >= begin && primitive < end; }
};

// The scene with visible lights as further spheres and meshes, after those it has, of emissive
// black materials: those of `shown`, by light. And for each light its primitives, or none. A disk
// is a polygon of so many corners that its edge is 5e-6 of the radius off. Flat lights lie in front
// of surfaces of the same plane, by 2^-44 of the coordinates.
struct SceneWithLights {
  Scene scene;
  std::vector<PrimitiveRange> primitives;
};
SceneWithLights AddLightShapes(const Scene& scene, const std::vector<bool>& shown);

// Takes over from `scene` all but shapes, and materials, which the caller does: one whose lights
// and shapes are those that `with` was made of. Flat lights are lifted for its camera.
void UpdateAllButShapes(const Scene& scene, SceneWithLights* with);

}  // namespace nacre
