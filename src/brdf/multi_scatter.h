// SPDX-License-Identifier: Apache-2.0
// brdf/multi_scatter.h: constants of the second lobe that compensates for the energy that a single
// bounce on microfacets loses. Turquin's factor 1 + F0 (1 / E - 1) on the lobe itself is in the
// models' Fresnel terms (shading/scalar_bsdf.h).
//
// E, the albedo for F = 1, comes from brdf/albedo.h, F_avg from brdf/fresnel.h.
#pragma once

#include <cmath>

#include "brdf/albedo.h"

namespace nacre {

// Kulla and Conty 2017, "Revisiting physically based shading at Imageworks": a second, reciprocal
// lobe (1 - E(n.v)) (1 - E(n.l)) / (pi (1 - E_avg)), from AlbedoLoss. KullaContyScale is
// 1 / (pi (1 - E_avg)), or 0 for a mirror, which loses nothing.
inline double KullaContyScale(double e_average) {
  const double loss = 1 - e_average;
  return loss > 0 ? 1 / (M_PI * loss) : 0;
}

// The colour of that lobe, of light that is reflected by F_avg at each further bounce:
// F_avg^2 E_avg / (1 - F_avg (1 - E_avg)). It is 1 for a white metal.
template <typename Real>
Real KullaContyFresnel(Real f_average, Real e_average) {
  return f_average * f_average * e_average / (1 - f_average * (1 - e_average));
}

}  // namespace nacre
