// SPDX-License-Identifier: Apache-2.0
// compare/flip_filters.h: the filters of FLIP (Andersson et al. 2020), in double.
#pragma once

#include "compare/plane.h"

namespace nacre {

// One dimension of each filter; all are separable. The filters of contrast sensitivity have a sum
// of 1, and turn opponent colours into perceived ones; that for blue-yellow is first_share *
// blue_yellow[0] + (1 - first_share) * blue_yellow[1].
//
// `edge` and `point` are the first and second derivative of the Gaussian `smooth`, scaled so that a
// step or a dot in [0, 1] gives at most 1; each is applied in one direction with `smooth` in the
// other, both ways round.
struct FlipFilters {
  Kernel luminance, red_green;
  Kernel blue_yellow[2];
  double first_share = 1;
  Kernel smooth, edge, point;
};

FlipFilters MakeFlipFilters(double pixels_per_degree);

// The largest radius of the filters, in pixels.
int RadiusOf(const FlipFilters& filters);

}  // namespace nacre
