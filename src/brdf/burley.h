// SPDX-License-Identifier: Apache-2.0
// brdf/burley.h: the diffuse term of Burley 2012, "Physically-Based Shading at Disney",
// section 5.3. SIMD twin: burley-inl.h.
//
// The term is fitted to measured materials: darker towards grazing angles for smooth surfaces,
// brighter for rough ones. It is reciprocal, but does not conserve energy: a white rough surface
// reflects more than it receives at grazing angles, up to 1.56 times at roughness 1. brdf/eon.h
// conserves energy.
#pragma once

#include <cmath>

#include "brdf/angles.h"
#include "brdf/fresnel.h"

namespace nacre {

// (1 - cos)^5.
template <typename Real>
Real BurleyGrazing(Real cos) {
  return Power5(1 - cos);
}

// The BRDF per unit of albedo: 1 / pi times a Schlick-like factor for each of n.l and n.v, whose
// F90 depends on half the angle between light and viewer. `roughness` is perceptual. The result is
// 0 unless light and viewer are above the surface.
template <typename Real>
Real BurleyDiffuse(const Angles<Real>& a, Real roughness) {
  if (!(a.n_dot_l > 0) || !(a.n_dot_v > 0)) return 0;
  // F90 - 1 = 2 roughness (v.h)^2 - 1/2, and (v.h)^2 = |u|^2 / 4.
  const Real rise = roughness * a.u_squared / 2 - static_cast<Real>(0.5);
  return (1 + rise * BurleyGrazing(a.n_dot_l)) * (1 + rise * BurleyGrazing(a.n_dot_v)) /
         static_cast<Real>(M_PI);
}

// The directional albedo of a white surface at grazing angles, above 1 from roughness 0.5 on. It is
// the integral of BurleyDiffuse over the directions of light, in Beta functions: the means over the
// azimuth of `rise` and its square are a = roughness - 1/2 and a^2 + roughness^2 sin^2 / 2.
template <typename Real>
Real BurleyGrazingAlbedo(Real roughness) {
  const Real a = roughness - static_cast<Real>(0.5);
  const Real mean_weight = static_cast<Real>(1.0 / 21);  // cosine-weighted mean of BurleyGrazing
  const Real mean_cos2 = static_cast<Real>(1.0 / 252);   // that of BurleyGrazing times cos^2
  return 1 + a * (1 + mean_weight) + a * a * mean_weight +
         roughness * roughness / 2 * (mean_weight - mean_cos2);
}

}  // namespace nacre
