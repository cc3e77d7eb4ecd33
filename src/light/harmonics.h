// SPDX-License-Identifier: Apache-2.0
// light/harmonics.h: an environment's diffuse irradiance from nine numbers a channel: its spherical
// harmonics to order 2, convolved with the clamped cosine. Ramamoorthi and Hanrahan 2001, "An
// Efficient Representation for Irradiance Environment Maps". SIMD twin: harmonics-inl.h.
//
// Exact for environments that are quadratic in the direction. What is left out are the cosine's
// orders 4, 6, ...: of a single distant light at most 0.094 of what it gives at normal incidence
// (at its terminator), of a sky three times as bright at the horizon as elsewhere 2 %.
#pragma once

#include <array>
#include <cstddef>

#include "light/environment.h"

namespace nacre {

inline constexpr size_t kHarmonics = 9;

template <typename Real>
using HarmonicBasis = std::array<Real, kHarmonics>;

// The real harmonics of orders 0 to 2, orthonormal over the sphere: (0,0); (1,-1), (1,0), (1,1);
// (2,-2), ... (2,2).
template <typename Real>
HarmonicBasis<Real> EvaluateHarmonics(const Imath::Vec3<Real>& d) {
  const Real k0 = static_cast<Real>(0.28209479177387814);   // sqrt(1 / 4 pi)
  const Real k1 = static_cast<Real>(0.48860251190291992);   // sqrt(3 / 4 pi)
  const Real k2 = static_cast<Real>(1.0925484305920792);    // sqrt(15 / 4 pi)
  const Real k20 = static_cast<Real>(0.31539156525252005);  // sqrt(5 / 16 pi)
  return {k0,
          k1 * d.y,
          k1 * d.z,
          k1 * d.x,
          k2 * d.x * d.y,
          k2 * d.y * d.z,
          k20 * (3 * d.z * d.z - 1),
          k2 * d.x * d.z,
          k2 / 2 * (d.x - d.y) * (d.x + d.y)};
}

// Coefficients of the irradiance: those of the radiance times the cosine's, pi, 2 pi / 3, pi / 4.
template <typename Real>
struct IrradianceHarmonics {
  std::array<Imath::Vec3<Real>, kHarmonics> coefficients;  // of red, green and blue
};

// The same on any number of threads.
IrradianceHarmonics<double> ProjectIrradiance(const EnvironmentMap& map, int threads = 1);

// Not below 0, where a bright light's ringing would take it.
template <typename Real>
Imath::Vec3<Real> Irradiance(const IrradianceHarmonics<Real>& harmonics,
                             const Imath::Vec3<Real>& normal) {
  const HarmonicBasis<Real> basis = EvaluateHarmonics(normal);
  Imath::Vec3<Real> sum(0);
  for (size_t i = 0; i < kHarmonics; ++i) sum += harmonics.coefficients[i] * basis[i];
  const Real zero = 0;
  return {std::max(sum.x, zero), std::max(sum.y, zero), std::max(sum.z, zero)};
}

}  // namespace nacre
