// SPDX-License-Identifier: Apache-2.0
// study/blinn_exponent.h: the exponent with which Blinn's lobe (n.h)^m comes nearest to Phong's
// (r.v)^n, in the least squares of what is compared: there is more than one answer.
#pragma once

#include "base/vec.h"

namespace nacre {

struct BlinnMatch {
  double exponent = 0;      // m
  double rms_residual = 0;  // of lobes whose peak is 1, over what is compared
};

// Over the viewer's angle in the plane of incidence, up to 90 degrees from the mirror direction.
// The half vector turns half as fast as the viewer: m is about 4 n.
BlinnMatch MatchInPlane(double n);

// m for which both lobes are 1/2 at the same angle in that plane.
double MatchHalfMaximum(double n);

// Over the picture of a sphere seen from far away on the axis (0, 0, 1), under light from
// `to_light`.
BlinnMatch MatchOnSphere(double n, const Vec3d& to_light);

// Over all viewers above a surface, with the light at this angle from its normal.
BlinnMatch MatchOnHemisphere(double n, double light_deg);

}  // namespace nacre
