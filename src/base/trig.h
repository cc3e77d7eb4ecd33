// SPDX-License-Identifier: Apache-2.0
// base/trig.h: trigonometric functions for solid angles that the standard library lacks. SIMD twin:
// trig-inl.h.
#pragma once

#include <cmath>

namespace nacre {

// (x - atan x) / x^3 for x >= 0: 1/3 at 0. For expressions in which the first term of an arc
// tangent cancels.
template <typename Real>
Real AtanRemainder(Real x) {
  const Real z = x * x;
  if (x > static_cast<Real>(0.25)) return (1 - std::atan(x) / x) / z;
  Real sum = 0;  // the power series, to 4^-26
  for (int k = 12; k >= 0; --k) sum = 1 / static_cast<Real>(2 * k + 3) - z * sum;
  return sum;
}

// angle / sin(angle) - 1 for an angle in [0, pi) given by the tangent of its half.
template <typename Real>
Real ArcExcess(Real tan_half) {
  const Real z = tan_half * tan_half;
  return z * (1 - (1 + z) * AtanRemainder(tan_half));
}

}  // namespace nacre
