// SPDX-License-Identifier: Apache-2.0
// render/sphere_pictures.h: where spheres and their outlines lie on the film.
#pragma once

#include <optional>
#include <vector>

#include "hit/camera_frame.h"
#include "visibility/sphere_bins.h"
#include "visibility/tile_kernel.h"

namespace nacre {

// A sphere's picture, inside bounds on the film and, seen in perspective, inside a cone.
struct SpherePicture {
  const TileCandidate* candidate;
  ProjectedBounds bounds;
  Vec3d axis;         // unit, towards the centre
  double half_angle;  // of the cone
  bool has_outline;   // false: the camera is inside
  bool whole;  // false: the plane in which parallel rays begin cuts the sphere, or it is behind
  // The outline is a circle around the centre, as seen from the camera. Where parallel rays begin
  // behind the middle of the sphere, it is where their plane cuts the sphere.
  double outline_radius;
  // How far from the camera the outline is, or, where all rays are parallel, the centre along them:
  // all that is seen of a whole sphere is nearer.
  double outline_depth;
};

// Of all candidates; none if there are more than can be looked through.
std::optional<std::vector<SpherePicture>> PicturesOf(const CameraFrame& frame,
                                                     const TileCandidates& candidates);

// The outlines that may be seen in a square of the film.
struct SeenOutlines {
  bool any = false;
  bool background = true;  // false: a sphere covers all of the square
  // The sphere, if there is one outline, a whole one, and no other sphere is seen.
  const TraceSphere* alone = nullptr;
};

// Within `reach` pixels of (x, y) along each axis. An outline that crosses this square is among
// them, unless a nearer sphere covers it.
SeenOutlines OutlinesAround(const CameraFrame& frame, const std::vector<SpherePicture>& pictures,
                            double x, double y, double reach);

}  // namespace nacre
