// SPDX-License-Identifier: Apache-2.0
// visibility/slopes.h: the interval of slopes under which a disc is seen from a point in its plane,
// which is the extent of a sphere's projection along one film axis.
#pragma once

#include <cmath>
#include <limits>

namespace nacre {

struct SlopeRange {
  double low, high;
};

// The slopes x / z, for z > 0, under which a disc of this radius about (x, z), z > -radius, is seen
// from the origin: between the tangents, x z -+ r sqrt(x^2 + z^2 - r^2) over z^2 - r^2. A disc that
// extends behind the origin has at most one tangent in front of it.
inline SlopeRange Slopes(double x, double z, double radius) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double product = (z - radius) * (z + radius);
  if (z > radius * (1 + 1e-6) && product > 0) {
    const double root = radius * std::sqrt(x * x + product);
    return {(x * z - root) / product, (x * z + root) / product};
  }
  return {x > radius ? (x - radius) / (z + radius) : -infinity,
          x < -radius ? (x + radius) / (z + radius) : infinity};
}

}  // namespace nacre
