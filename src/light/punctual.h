// SPDX-License-Identifier: Apache-2.0
// light/punctual.h: how the irradiance of point and spot lights falls off. SIMD twin:
// punctual-inl.h. The factors here multiply the light's intensity and give the irradiance
// perpendicular to the light's direction.
#pragma once

#include <cmath>

namespace nacre {

// Fall-off 1 / (constant + linear d + quadratic d^2) at distance d; 0 at the light itself, where
// the fall-off may be unbounded and there is no direction.
template <typename Real>
struct AttenuationTerms {
  Real constant, linear, quadratic;
};

template <typename Real>
Real AttenuationFactor(const AttenuationTerms<Real>& a, Real distance) {
  const Real denominator = (a.quadratic * distance + a.linear) * distance + a.constant;
  return denominator > 0 && distance > 0 ? 1 / denominator : 0;
}

// A spot's cone. Angles from its axis are given by 1 - cos, because a cosine loses the digits of
// small angles: 1 - cos of 0.01 degrees is 1.5e-8.
template <typename Real>
struct ConeTerms {
  Real cutoff;  // dark from this angle on
  Real inner;   // no penumbra up to this angle; equal to `cutoff` for a hard edge
  Real exponent;
  // The penumbra is t^2 (edge[0] + edge[1] t), where t is linear in the cosine, from 0 at the
  // cutoff to 1 at the inner angle: smoothstep, or a square.
  Real edge[2] = {3, -2};
};

// 1 - cos of an angle in degrees.
inline double OneMinusCosine(double degrees) {
  const double sine = std::sin(degrees * (M_PI / 360));
  return 2 * sine * sine;
}

// 1 - cos of the angle between two unit vectors: half the square of their distance, because 1 minus
// their dot product would have an absolute error of 1e-16, not a relative one.
template <typename Vec>
auto OneMinusCosine(const Vec& a, const Vec& b) {
  return (a - b).length2() / 2;
}

// The penumbra's t: 0 at the cutoff and beyond it, 1 within the inner angle.
template <typename Real>
Real PenumbraParameter(const ConeTerms<Real>& cone, Real one_minus_cos) {
  if (!(one_minus_cos < cone.cutoff)) return 0;
  if (one_minus_cos <= cone.inner) return 1;
  return (cone.cutoff - one_minus_cos) / (cone.cutoff - cone.inner);
}

// cos^exponent strictly inside the cone, times a penumbra between cutoff and inner angle. Equality
// with the cutoff is dark. A cosine below 0 (cutoff over 90 degrees) counts as 0 for the exponent.
template <typename Real>
Real SpotFactor(const ConeTerms<Real>& cone, Real one_minus_cos) {
  const Real t = PenumbraParameter(cone, one_minus_cos);
  const Real edge = t * t * (cone.edge[0] + cone.edge[1] * t);
  if (cone.exponent == 0) return edge;
  return one_minus_cos < 1 ? edge * std::exp(cone.exponent * std::log1p(-one_minus_cos)) : 0;
}

}  // namespace nacre
