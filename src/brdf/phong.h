// SPDX-License-Identifier: Apache-2.0
// brdf/phong.h: the specular lobes of the Phong family. SIMD twin: phong-inl.h.
//
// With c the lobe's cosine, c^n = exp(n log(c)) loses n roundings of c when written that way:
// 14 % rms at n = 1e6 in float. Written with x = 1 - c, computed without cancellation,
// exp(n log1p(-x)) is accurate for any n.
#pragma once

#include <cmath>

#include "brdf/angles.h"

namespace nacre {

// c^n for c = 1 - x, both computed without cancellation: 0 where c <= 0, but 1 everywhere for
// n = 0 (also 0^0: an exponent of 0 is a constant lobe).
template <typename Real>
Real LobePower(Real x, Real c, Real n) {
  if (n == 0) return 1;
  if (!(c > 0)) return 0;
  return std::exp(n * (2 * x < 1 ? std::log1p(-x) : std::log(c)));
}

// Phong 1975: max(r.v, 0)^n, r = 2 n (n.l) - l, without the test of n.l > 0. For unit vectors
// r.v = 1 - |r - v|^2 / 2. At the peak of the lobe, where n times the rounding error of r.v would
// be visible, r - v is small, and so is the effect of its rounding errors.
template <typename Real>
Real PhongLobe(const Imath::Vec3<Real>& normal, const Imath::Vec3<Real>& to_light,
               const Imath::Vec3<Real>& to_view, Real shininess) {
  const Real one_minus_c = (Mirrored(to_light, normal) - to_view).length2() / 2;
  return LobePower(one_minus_c, 1 - one_minus_c, shininess);
}

// Blinn 1977: max(n.h, 0)^n = (1 - sin^2)^(n/2), without the test of n.l > 0. The result is 0 where
// h is undefined (l = -v) or below the surface.
template <typename Real>
Real BlinnLobe(const Angles<Real>& a, Real shininess) {
  if (shininess == 0) return 1;
  if (!(a.n_dot_u > 0)) return 0;
  const Real cos2 = a.n_dot_u * a.n_dot_u;
  // |u|^2 as (n.u)^2 + |n x u|^2: both ratios stay in [0, 1] whatever the rounding.
  const Real u_squared = cos2 + a.nxu_squared;
  return LobePower(a.nxu_squared / u_squared, cos2 / u_squared, shininess / 2);
}

// The scale with which the lobe c^n n.l, viewed along the normal, has a reflectance of 1. Lobes
// without n.l then also reflect all light that arrives along the normal, where n.l is 1.
// For Phong and modified Phong it is (n + 2) / 2 pi (Lafortune and Willems 1994).
template <typename Real>
Real PhongNormalization(Real shininess) {
  return (shininess + 2) / (2 * static_cast<Real>(M_PI));
}

// Blinn-Phong: (n + 2)(n + 4) / (8 pi (2^(-n/2) + n)) (Giesen 2009).
template <typename Real>
Real BlinnNormalization(Real shininess) {
  return (shininess + 2) * (shininess + 4) /
         (8 * static_cast<Real>(M_PI) * (std::exp2(-shininess / 2) + shininess));
}

// The radiance that a viewer along the normal sees of a lobe with that scale and without n.l under
// light of radiance 1 from everywhere (the furnace test): the scale times the integral of c^n
// alone. It is more than 1 at every exponent, 2 at exponent 0, and the maximum over all view
// directions. (The lobe is not reciprocal: it reflects all of the light that arrives along the
// normal, and any multiple of light that grazes the surface, because as a BRDF it is divided by
// n.l.) For Phong it is (n + 2) / (n + 1).
template <typename Real>
Real PhongFurnace(Real shininess) {
  return (shininess + 2) / (shininess + 1);
}

// Blinn-Phong: the integral is 8 pi (1 - 2^(-n/2 - 1)) / (n + 2), over h up to 45 degrees from n.
template <typename Real>
Real BlinnFurnace(Real shininess) {
  const Real power = std::exp2(-shininess / 2);
  return (shininess + 4) * (1 - power / 2) / (power + shininess);
}

}  // namespace nacre
