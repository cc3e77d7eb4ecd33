// SPDX-License-Identifier: Apache-2.0
// brdf/fresnel.h: reflectance of a smooth interface, and its average. SIMD twin: fresnel-inl.h.
#pragma once

#include <algorithm>
#include <cmath>

#include "brdf/angles.h"

namespace nacre {

// 1 - v.h, computed as (|l - v|^2 / 4) / (1 + |u| / 2): v.h is near 1 wherever a surface is seen
// from the front, and subtracting it from 1 would leave only rounding error. Where light and viewer
// are opposed, 1 - v.h is rounded to either side of 1; a value above 1 would make 1 - F, and so the
// diffuse light, negative.
template <typename Real>
Real OneMinusVDotH(const Angles<Real>& a) {
  const Real ratio = a.lv_squared / (4 + 2 * std::sqrt(a.u_squared));
  return ratio < 1 ? ratio : 1;
}

// v.h itself: |l + v| / 2.
template <typename Real>
Real VDotH(const Angles<Real>& a) {
  return std::sqrt(a.u_squared) / 2;
}

template <typename Real>
Real Power5(Real x) {
  const Real squared = x * x;
  return squared * squared * x;
}

// (1 - v.h)^5, the angular weight of Schlick's approximation.
template <typename Real>
Real SchlickWeight(const Angles<Real>& a) {
  return Power5(OneMinusVDotH(a));
}

// Schlick 1994, eq. 15: F0 + (1 - F0)(1 - v.h)^5.
template <typename Real>
Real FresnelSchlick(Real f0, Real schlick_weight) {
  return f0 + (1 - f0) * schlick_weight;
}

// Schlick's approximation with another reflectance at grazing incidence: F0 + (F90 - F0)
// (1 - v.h)^5.
template <typename Real>
Real FresnelSchlick(Real f0, Real f90, Real schlick_weight) {
  return f0 + (f90 - f0) * schlick_weight;
}

// Reflectance at normal incidence of a dielectric with index of refraction 1.5.
inline constexpr double kDielectricF0 = 0.04;

// Reflectance at normal incidence: ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2). A dielectric has
// k = 0.
template <typename Real>
Real FresnelF0(Real eta, Real k) {
  return ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
}

// Fresnel's equations, unpolarised, for a dielectric of relative index eta = n_t / n_i (Born and
// Wolf, 1.5.2). The differences in their numerators cancel for eta near 1; with g = eta
// cos(theta_t) they are c - g = (1 - eta^2) / (c + g) and eta^2 c - g = (eta^2 - 1)(eta^2 c^2 -
// sin^2) / (eta^2 c + g). The result is 1 where reflection is total.
template <typename Real>
Real FresnelDielectric(Real v_dot_h, Real one_minus_vh, Real eta) {
  const Real eta2 = eta * eta;
  const Real contrast = (eta - 1) * (eta + 1);
  const Real cos2 = v_dot_h * v_dot_h;
  const Real sin2 = one_minus_vh * (1 + v_dot_h);
  // g^2 = eta^2 - sin^2, in the form that cancels nowhere but at the critical angle itself.
  const Real g2 = eta < 1 ? eta2 - sin2 : contrast + cos2;
  if (!(g2 > 0)) return 1;
  const Real g = std::sqrt(g2);
  const Real s = 1 / ((v_dot_h + g) * (v_dot_h + g));
  const Real p = (eta2 * cos2 - sin2) / ((eta2 * v_dot_h + g) * (eta2 * v_dot_h + g));
  return contrast * contrast * (s * s + p * p) / 2;
}

// Fresnel's curve of a dielectric base of which a coat covers the fraction `coat`: the reflectance
// in air, of the relative index `eta`, and below the coat, of the relative index `eta_in_coat`, to
// which light comes refracted by the coat, whose index is 1 / inverse_coat_eta [Coat / Total
// internal reflection].
template <typename Real>
struct CoatedDielectric {
  Real eta = 1;
  Real coat = 0;  // in [0, 1]
  Real eta_in_coat = 1, inverse_coat_eta = 1;

  bool operator==(const CoatedDielectric&) const = default;
};

template <typename Real>
Real FresnelCoatedDielectric(Real v_dot_h, Real one_minus_vh, const CoatedDielectric<Real>& base) {
  const Real in_air = FresnelDielectric(v_dot_h, one_minus_vh, base.eta);
  if (!(base.coat > 0)) return in_air;
  const Real sin2 = one_minus_vh * (1 + v_dot_h) * base.inverse_coat_eta * base.inverse_coat_eta;
  Real in_coat = 0;  // where a coat that is thinner than air reflects all light itself
  if (sin2 < 1) {
    const Real cos = std::sqrt(1 - sin2);
    in_coat = FresnelDielectric(cos, sin2 / (1 + cos), base.eta_in_coat);
  }
  return in_air + base.coat * (in_coat - in_air);
}

// Fresnel's equations, unpolarised, for a conductor of index eta + i k seen from vacuum, with
// (a + i b)^2 = (eta + i k)^2 - sin^2 (Born and Wolf, 14.2). The smaller of a^2 and b^2 follows
// from a b = eta k, and the numerators are sums of squares: nothing cancels.
template <typename Real>
Real FresnelConductor(Real v_dot_h, Real one_minus_vh, Real eta, Real k) {
  const Real sin2 = one_minus_vh * (1 + v_dot_h);
  const Real ab = eta * k;
  const Real difference = (eta - k) * (eta + k) - sin2;  // a^2 - b^2
  const Real sum = std::sqrt(difference * difference + 4 * ab * ab);
  const Real larger = (sum + std::abs(difference)) / 2;
  const Real smaller = larger > 0 ? ab * ab / larger : 0;
  const Real a = std::sqrt(difference > 0 ? larger : smaller);
  const Real b2 = difference > 0 ? smaller : larger;
  const auto squares = [](Real x, Real y2) { return x * x + y2; };
  const Real b2_cos2 = b2 * v_dot_h * v_dot_h;
  const Real a_cos = a * v_dot_h;
  const Real s_below = squares(a + v_dot_h, b2);
  if (!(s_below > 0)) return 0;  // no interface (eta = 1, k = 0), at grazing incidence
  const Real s = squares(a - v_dot_h, b2) / s_below;
  const Real p = squares(a_cos - sin2, b2_cos2) / squares(a_cos + sin2, b2_cos2);
  return s * (1 + p) / 2;
}

// F82 is Schlick's curve minus b c (1 - c)^6, which makes it pass through a second value at
// cos = 1/7, where the reflectance of metals dips (Kutz, Hasan and Edmondson 2021, eq. 6; the
// "F82-tint" of OpenPBR). F82Slope is b for the reflectance f82 at that angle.
template <typename Real>
Real F82Slope(Real f0, Real f82) {
  const Real weight = Power5(Real(6) / 7);
  return (FresnelSchlick(f0, Real(1), weight) - f82) / (weight * 6 / 49);
}

// b for a tint, which multiplies Schlick's value at cos = 1/7.
template <typename Real>
Real F82SlopeFromTint(Real f0, Real tint) {
  return F82Slope(f0, tint * FresnelSchlick(f0, Real(1), Power5(Real(6) / 7)));
}

// The curve is clamped to [0, 1], which it leaves for very dark and very bright tints.
template <typename Real>
Real FresnelF82(Real v_dot_h, Real one_minus_vh, Real f0, Real slope) {
  const Real weight = Power5(one_minus_vh);
  const Real value = FresnelSchlick(f0, Real(1), weight) - slope * v_dot_h * one_minus_vh * weight;
  return std::min(std::max(value, Real(0)), Real(1));
}

// Curves averaged over the hemisphere, F_avg = 2 int F(c) c dc: the average reflectance at each
// bounce of light between microfacets.
//
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
double AverageDielectric(const CoatedDielectric<double>& base);
double AverageConductor(double eta, double k);

}  // namespace nacre
