// SPDX-License-Identifier: Apache-2.0
// base/basis.h: right-handed orthonormal bases about a given axis. SIMD twin: basis-inl.h.
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

}  // namespace nacre
