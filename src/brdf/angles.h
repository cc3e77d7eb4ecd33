// SPDX-License-Identifier: Apache-2.0
// brdf/angles.h: the variables of every reflection model: the angles between a surface's normal, a
// light and a viewer, in forms that keep their precision. SIMD twin: angles-inl.h.
//
// Directions are unit length and point away from the surface. The sum u = l + v stays
// un-normalised: h = u/|u|, and everything about h follows from u without dividing.
#pragma once

#include <cmath>

#include "base/vec.h"

namespace nacre {

// The vector v mirrored about the unit vector m.
template <typename Real>
Imath::Vec3<Real> Mirrored(const Imath::Vec3<Real>& v, const Imath::Vec3<Real>& m) {
  return m * (2 * (m ^ v)) - v;
}

template <typename Real>
struct Angles {
  Real n_dot_l;
  Real n_dot_v;
  Real n_dot_u;      // |u| cos(theta_h); its sign tells on which side h lies
  Real u_squared;    // |l + v|^2 = 4 (v.h)^2
  Real nxu_squared;  // |n x u|^2 = |u|^2 sin^2(theta_h)
  Real lv_squared;   // |l - v|^2 = 4 (1 - (v.h)^2)
};

// u = l + v. For unit vectors u is perpendicular to l - v, but rounding makes |l| and |v| differ,
// which tilts a small u (light and viewer opposed, both grazing) considerably. Its component along
// l - v is therefore subtracted; |l - v|^2 is 4 where that matters, so no division is needed.
template <typename Real>
Imath::Vec3<Real> HalfSum(const Imath::Vec3<Real>& l, const Imath::Vec3<Real>& v) {
  const Imath::Vec3<Real> l_minus_v = l - v;
  const Imath::Vec3<Real> sum = l + v;
  return sum - l_minus_v * ((sum ^ l_minus_v) / 4);
}

// Lagrange's identity gives sin^2(theta_h) = |n x u|^2 / |u|^2. Highlights of smooth surfaces
// depend on it, and once n.h is rounded, no rearrangement of 1 - (n.h)^2 recovers it.
template <typename Real>
Angles<Real> ComputeAngles(const Imath::Vec3<Real>& n, const Imath::Vec3<Real>& l,
                           const Imath::Vec3<Real>& v) {
  const Imath::Vec3<Real> u = HalfSum(l, v);
  return {n ^ l, n ^ v, n ^ u, u.length2(), (n % u).length2(), (l - v).length2()};
}

// l.v, as |l + v|^2 - |l - v|^2 = 4 l.v.
template <typename Real>
Real LightDotView(const Angles<Real>& a) {
  return (a.u_squared - a.lv_squared) / 4;
}

}  // namespace nacre
