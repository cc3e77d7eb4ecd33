// SPDX-License-Identifier: Apache-2.0
// base/concentric_disk.h: the area-preserving concentric map from the unit square to the unit disk.
// SIMD twin: concentric_disk-inl.h.
#pragma once

#include <cmath>

namespace nacre {

template <typename Real>
struct PointOnDisk {
  Real x, y;
  Real radius;  // exact, so that 1 - radius^2 is accurate; hypot(x, y) would be rounded
};

// Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square", for u in [0, 1].
template <typename Real>
PointOnDisk<Real> ConcentricDisk(Real u0, Real u1) {
  const Real a = 2 * u0 - 1, b = 2 * u1 - 1;
  const bool flat = std::abs(a) > std::abs(b);
  const Real larger = flat ? a : b, smaller = flat ? b : a;
  if (larger == 0) return {0, 0, 0};
  const Real phi = static_cast<Real>(M_PI / 4) * (smaller / larger);
  const Real along = larger * std::cos(phi), across = larger * std::sin(phi);
  return {flat ? along : across, flat ? across : along, std::abs(larger)};
}

}  // namespace nacre
