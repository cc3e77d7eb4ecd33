// brdf/fresnel.h: reflectance of a smooth interface. SIMD twin: fresnel-inl.h.
#pragma once

#include <cmath>

#include "brdf/angles.h"

namespace nacre {

// (1 - v.h)^5, the angular weight of Schlick's approximation. 1 - v.h is formed as
// (|l - v|^2 / 4) / (1 + |u| / 2): v.h is near 1 wherever a surface is looked at from the front.
// Where light and viewer are opposed it rounds to either side of 1; above 1 it would make 1 - F,
// and so the diffuse light, negative.
template <typename Real>
Real SchlickWeight(const Angles<Real>& a) {
  const Real ratio = a.lv_squared / (4 + 2 * std::sqrt(a.u_squared));
  const Real one_minus_vh = ratio < 1 ? ratio : 1;
  const Real squared = one_minus_vh * one_minus_vh;
  return squared * squared * one_minus_vh;
}

// Schlick 1994, eq. 15: F0 + (1 - F0)(1 - v.h)^5.
template <typename Real>
Real FresnelSchlick(Real f0, Real schlick_weight) {
  return f0 + (1 - f0) * schlick_weight;
}

// Reflectance at normal incidence of a dielectric with index of refraction 1.5.
inline constexpr double kDielectricF0 = 0.04;

}  // namespace nacre
