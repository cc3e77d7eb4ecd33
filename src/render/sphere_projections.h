// SPDX-License-Identifier: Apache-2.0
// render/sphere_projections.h: the projections of spheres and of their outlines onto the film.
#pragma once

#include <optional>
#include <vector>

#include "hit/camera_frame.h"
#include "visibility/sphere_bins.h"
#include "visibility/tile_kernel.h"

namespace nacre {

// The projection of a sphere onto the film, with bounds.
struct SphereProjection {
  const TileCandidate* candidate;
  ProjectedBounds bounds;  // on the film
  // Perspective only: the cone from the eye that holds the sphere. The axis is a unit vector.
  Vec3d axis;
  double half_angle;
  bool has_outline;  // false: the camera is inside
  // False: the plane in which an orthographic camera's rays start cuts the sphere, or the sphere is
  // behind it.
  bool whole;
  // The outline is a circle around the axis from the camera through the centre. If the orthographic
  // camera's rays start behind the centre, it is the circle in which their plane cuts the sphere.
  double outline_radius;
  // The distance of the outline from the eye, or the depth of the centre (orthographic). All
  // visible points of a whole sphere are nearer.
  double outline_depth;
};

// Projects all candidates. Returns nullopt if there are too many to search for each pixel.
std::optional<std::vector<SphereProjection>> ProjectSpheres(const CameraFrame& frame,
                                                            const TileCandidates& candidates);

// What is visible in a square of the film.
struct VisibleOutlines {
  bool any = false;        // an outline may cross the square
  bool background = true;  // false: a sphere covers the whole square
  // The sphere of the outline if it is the only sphere in the square and its projection is whole.
  const TraceSphere* only_sphere = nullptr;
};

// Finds the outlines in a square that is centred at (x, y) and has sides of twice `half_side`
// pixels. `any` is true for every outline that crosses it, unless a nearer sphere covers the
// square.
VisibleOutlines FindVisibleOutlines(const CameraFrame& frame,
                                    const std::vector<SphereProjection>& projections, double x,
                                    double y, double half_side);

}  // namespace nacre
