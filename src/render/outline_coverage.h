// SPDX-License-Identifier: Apache-2.0
// render/outline_coverage.h: the share of a pixel that a sphere covers, computed exactly where the
// sphere's outline, which is an ellipse on the film, crosses the pixel.
#pragma once

#include "hit/camera_frame.h"
#include "visibility/geometry.h"

namespace nacre {

// A quadratic form that describes an outline around a point on the film: the ray through that point
// displaced by (dx, dy) pixels hits the sphere where
//   xx dx^2 + 2 xy dx dy + yy dy^2 + 2 x dx + 2 y dy + one
// is not negative.
struct OutlineForm {
  double xx, xy, yy, x, y, one;
};

// Makes the form of a sphere whose whole outline lies in front of the camera, around a film
// position.
OutlineForm MakeOutlineForm(const CameraFrame& frame, const TraceSphere& sphere, double film_x,
                            double film_y);

// Whether the outline is an ellipse of so small a curvature that CoveredShare is accurate.
bool IsGentlyCurved(const OutlineForm& outline);

// The share, in [0, 1], of a square on the film that the sphere covers. The square is centred at
// the form's point and has sides of twice `half_side` pixels, at most one pixel. Requires
// IsGentlyCurved, and is then accurate to 1e-8.
double CoveredShare(const OutlineForm& outline, double half_side);

// The offset on the film, in pixels, from the square's centre of a point in the covered part, away
// from the part's border even if the part is small. Requires a share above 0.
Vec2d OffsetIntoCovered(const OutlineForm& outline, double half_side);

}  // namespace nacre
