// SPDX-License-Identifier: Apache-2.0
// hit/camera_frame.h: a camera as vectors from which rays are made and by which spheres are
// projected. Data only, made by render/camera.h.
#pragma once

#include "base/vec.h"
#include "scene/camera.h"

namespace nacre {

// A camera's basis, relative to the camera's position. The ray through film position
// (x, y), in pixels from the top left corner of the full frame, has the direction
// corner + x step_x + y step_y from the origin (perspective), or that origin and the direction
// `forward` (orthographic).
struct CameraFrame {
  Projection projection;
  Vec3d forward;  // unit viewing direction
  Vec3d corner;   // perspective: direction through film (0, 0); orthographic: origin there
  // The change of that direction or origin per pixel. Both are perpendicular to `forward` and to
  // each other.
  Vec3d step_x;
  Vec3d step_y;
};

// Decides which spheres the rays of a camera test in the film plane
// (visibility/projected_sphere_test.h). By default there are none.
struct ProjectedTestView {
  Vec3d forward{0, 0, 0};
  double max_scale = 0;  // the largest depth / radius of such spheres
};

}  // namespace nacre
