// SPDX-License-Identifier: Apache-2.0
// render/outline_coverage.h: how much of a pixel a sphere covers, exactly: near its outline, which
// a camera sees as an ellipse.
#pragma once

#include "hit/camera_frame.h"
#include "visibility/geometry.h"

namespace nacre {

// Around a place on the film: the ray through the place displaced by (dx, dy) pixels hits where
//   xx dx^2 + 2 xy dx dy + yy dy^2 + 2 x dx + 2 y dy + one
// is not negative.
struct OutlineForm {
  double xx, xy, yy, x, y, one;
};

// For a sphere whose whole outline lies before the camera.
OutlineForm OutlineAround(const CameraFrame& frame, const TraceSphere& sphere, double film_x,
                          double film_y);

// Whether the outline is an ellipse that bends so little everywhere that CoveredShare holds.
bool BendsLittle(const OutlineForm& outline);

// The share, in [0, 1], of the square within `reach` pixels of the place, reach <= 0.5, that is
// where the form is not negative, to 1e-8, if the outline bends little.
double CoveredShare(const OutlineForm& outline, double reach);

// A place within that part of the square, from the square's middle: well inside of it where the
// part is small. Needs a share above 0.
struct FilmStep {
  double dx, dy;
};
FilmStep CoveredPlace(const OutlineForm& outline, double reach);

}  // namespace nacre
