// SPDX-License-Identifier: Apache-2.0
// visibility/slopes.h: how a disc is seen from a point in its plane: what a sphere's outline comes
// to along either axis of a film.
#pragma once

#include <cmath>
#include <limits>

namespace nacre {

struct Interval {
  double low, high;
};

// The slopes x / z under which a disc of this radius about (x, z), z > -radius, is seen from the
// origin in front of it, z > 0: between the tangents, x z -+ r sqrt(x^2 + z^2 - r^2) over
// z^2 - r^2. A disc that reaches behind the origin has one tangent or none in front.
inline Interval Slopes(double x, double z, double radius) {
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
