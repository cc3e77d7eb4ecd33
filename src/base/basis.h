// SPDX-License-Identifier: Apache-2.0
// base/basis.h: right-handed orthonormal bases about a given axis, directions around it, and points
// of the unit disk. SIMD twin: basis-inl.h.
#pragma once

#include <cmath>

#include "base/vec.h"

namespace nacre {

template <typename Real>
struct Basis {
  Imath::Vec3<Real> x, y, z;

  Imath::Vec3<Real> ToWorld(const Imath::Vec3<Real>& local) const {
    return x * local.x + y * local.y + z * local.z;
  }
  Imath::Vec3<Real> ToLocal(const Imath::Vec3<Real>& world) const {
    return {x ^ world, y ^ world, z ^ world};
  }
};

// Duff et al. 2017, "Building an Orthonormal Basis, Revisited": accurate for every unit z, also
// next to the pole, where Frisvad's form of 2012 breaks down.
template <typename Real>
Basis<Real> BasisAbout(const Imath::Vec3<Real>& z) {
  const Real sign = std::copysign(static_cast<Real>(1), z.z);
  const Real a = -1 / (sign + z.z);
  const Real b = z.x * z.y * a;
  return {{1 + sign * z.x * z.x * a, sign * b, -sign * z.x}, {b, sign + z.y * z.y * a, -z.y}, z};
}

// The direction at 1 - cos = x from `axis`, with azimuth 2 pi u1.
template <typename Real>
Imath::Vec3<Real> DirectionAround(const Imath::Vec3<Real>& axis, Real x, Real u1) {
  const Real sin = std::sqrt(x * (2 - x));
  const Real phi = 2 * static_cast<Real>(M_PI) * u1;
  return BasisAbout(axis).ToWorld({sin * std::cos(phi), sin * std::sin(phi), 1 - x});
}

template <typename Real>
struct PointOnDisk {
  Real x, y;
  Real radius;  // exact, so that 1 - radius^2 is accurate; hypot(x, y) would be rounded
};

// The area-preserving concentric map from the unit square to the unit disk: Shirley and Chiu 1997,
// "A Low Distortion Map Between Disk and Square", for u in [0, 1].
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
