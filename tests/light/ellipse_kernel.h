// SPDX-License-Identifier: Apache-2.0
// tests/light/ellipse_kernel.h: ellipse_irradiance-inl.h called from a test.
#pragma once

#include <vector>

#include "light/ellipse_irradiance.h"

namespace nacre {

struct EllipseQuery {
  EllipseLight light;
  Vec3d normal;
};

std::vector<double> AskEllipses(const std::vector<EllipseQuery>& queries);

}  // namespace nacre
