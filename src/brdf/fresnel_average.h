// SPDX-License-Identifier: Apache-2.0
// brdf/fresnel_average.h: Fresnel curves averaged over the hemisphere, F_avg = 2 int F(c) c dc: the
// average reflectance at each bounce of light between microfacets.
#pragma once

namespace nacre {

// Schlick: F0 + (F90 - F0) / 21, as 2 int (1 - c)^5 c dc = 1/21.
template <typename Real>
Real AverageSchlick(Real f0, Real f90 = 1) {
  return f0 + (f90 - f0) / 21;
}

// F82: 2 int c^2 (1 - c)^6 dc = 1/126. Exact where the curve stays within [0, 1] unclamped.
template <typename Real>
Real AverageF82(Real f0, Real slope) {
  return AverageSchlick(f0) - slope / 126;
}

// Computed by quadrature, to 1e-12.
double AverageDielectric(double eta);
double AverageConductor(double eta, double k);

}  // namespace nacre
