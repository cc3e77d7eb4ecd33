// SPDX-License-Identifier: Apache-2.0
// study/blinn_exponent.h: the exponent m for which Blinn's lobe (n.h)^m is nearest to Phong's
// (r.v)^n by least squares. It depends on the directions that are compared.
#pragma once

#include "base/vec.h"

namespace nacre {

struct BlinnMatch {
  double exponent = 0;      // m
  double rms_residual = 0;  // of lobes with peak 1, over the compared directions
};

// Compares over the viewer's angle in the plane of incidence, up to 90 degrees from the mirror
// direction. The half vector turns half as fast as the viewer: m is about 4 n.
BlinnMatch MatchInPlane(double n);

// The m for which both lobes are 1/2 at the same angle in that plane.
double MatchHalfMaximum(double n);

// Compares over the picture of a sphere seen from far away on the axis (0, 0, 1), under light from
// `to_light`.
BlinnMatch MatchOnSphere(double n, const Vec3d& to_light);

// Compares over all viewers above a surface, with the light at this angle from its normal.
BlinnMatch MatchOnHemisphere(double n, double light_deg);

}  // namespace nacre
