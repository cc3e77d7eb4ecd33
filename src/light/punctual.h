// SPDX-License-Identifier: Apache-2.0
// light/punctual.h: how the irradiance of point and spot lights falls off. SIMD twin:
// punctual-inl.h. The factors here multiply the light's intensity and give the irradiance
// perpendicular to the light's direction.
#pragma once

#include <cmath>

namespace nacre {

// Fall-off 1 / (constant + linear d + quadratic d^2) at distance d. 0 at the light itself, where
// the fall-off has no limit and the light no direction.
template <typename Real>
struct AttenuationTerms {
  Real constant, linear, quadratic;
};

template <typename Real>
Real AttenuationFactor(const AttenuationTerms<Real>& a, Real distance) {
  const Real denominator = (a.quadratic * distance + a.linear) * distance + a.constant;
  return denominator > 0 && distance > 0 ? 1 / denominator : 0;
}

// A spot's cone. All cosines are of angles from the axis.
template <typename Real>
struct ConeTerms {
  Real cos_cutoff;  // dark where cos <= cos_cutoff
  Real cos_inner;   // full where cos >= cos_inner; == cos_cutoff: a hard edge
  Real exponent;
  // The penumbra is t^2 (edge[0] + edge[1] t), t from 0 at the cutoff to 1 at the inner angle:
  // smoothstep, or a square.
  Real edge[2] = {3, -2};
};

// cos^exponent strictly inside the cone, times a penumbra between cutoff and inner angle. Equality
// with the cutoff is dark. A cosine below 0 (cutoff over 90 degrees) counts as 0 for the exponent.
template <typename Real>
Real SpotFactor(const ConeTerms<Real>& cone, Real cos_angle) {
  if (!(cos_angle > cone.cos_cutoff)) return 0;
  const Real base = std::fmax(cos_angle, static_cast<Real>(0));
  Real factor = cone.exponent == 0 ? 1 : std::pow(base, cone.exponent);
  if (cos_angle < cone.cos_inner) {
    const Real t = (cos_angle - cone.cos_cutoff) / (cone.cos_inner - cone.cos_cutoff);
    factor *= t * t * (cone.edge[0] + cone.edge[1] * t);
  }
  return factor;
}

}  // namespace nacre
