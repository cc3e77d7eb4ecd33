// SPDX-License-Identifier: Apache-2.0
// brdf/ggx.h: GGX microfacet terms: distribution and masking-shadowing. SIMD twin: ggx-inl.h.
//
// alpha = roughness^2, converted in one place: AlphaFromRoughness. There is no floor: the stable
// forms below are right down to where the peak leaves the number range, and below that a surface
// is a delta lobe (IsDeltaLobe), which no point or directional light can show.
#pragma once

#include <cmath>
#include <cstdint>

#include "brdf/angles.h"

namespace nacre {

// Masking-shadowing of the microfacet models. They differ by up to half at grazing angles.
enum class Shadowing : uint8_t {
  kHeightCorrelated,  // Smith, height-correlated (Heitz 2014, eq. 99)
  kSeparable,         // Smith, product of two G1
  kSchlickDirect,     // Schlick's G1 with k = (roughness + 1)^2 / 8 (Karis 2013), as in src/lesson
  kSchlickIbl,        // Schlick's G1 with k = alpha / 2 (Karis 2013, for image-based light)
};

template <typename Real>
Real AlphaFromRoughness(Real roughness) {
  return roughness * roughness;
}

// Lobes below this roughness, whose alpha is below its square, are so narrow (1e-12 rad) that no
// picture resolves them. Their peak, 1 / (pi alpha^2), times light and visibility would leave the
// range of float: they are the delta lobes of a perfect mirror.
inline constexpr double kDeltaRoughness = 0x1p-20;  // 9.5e-7

template <typename Real>
bool IsDeltaLobe(Real alpha) {
  return alpha < static_cast<Real>(kDeltaRoughness * kDeltaRoughness);
}

// Walter et al. 2007, eq. 33, isotropic: alpha^2 / (pi (cos^2 alpha^2 + sin^2)^2) of the angle
// between n and h. Angles has cosine and sine times |u|: the factors cancel. The result is 0 where
// h lies below the surface or is undefined (l = -v), and for a delta lobe.
template <typename Real>
Real GgxDistribution(const Angles<Real>& a, Real alpha) {
  if (IsDeltaLobe(alpha) || !(a.n_dot_u > 0)) return 0;
  const Real scaled = a.n_dot_u * alpha;
  const Real denominator = scaled * scaled + a.nxu_squared;
  if (!(denominator > 0)) return 0;  // u underflowed: l = -v to working precision
  const Real k = alpha * a.u_squared / denominator;
  return k * k / static_cast<Real>(M_PI);
}

// The visibility terms V = G / (4 n.l n.v): the division by the cosines is done analytically, so
// nothing is singular at grazing angles. All require n.l > 0 and n.v >= 0.

// Smith's Lambda-like square root: n_dot_x times sqrt(1 + alpha^2 tan^2).
template <typename Real>
Real SmithRoot(Real n_dot_x, Real alpha) {
  return std::sqrt(alpha * alpha + (1 - alpha * alpha) * n_dot_x * n_dot_x);
}

// Height-correlated Smith: Heitz 2014, eq. 99.
template <typename Real>
Real VisibilityHeightCorrelated(Real n_dot_l, Real n_dot_v, Real alpha) {
  return 1 / (2 * (n_dot_l * SmithRoot(n_dot_v, alpha) + n_dot_v * SmithRoot(n_dot_l, alpha)));
}

// Separable Smith: Walter et al. 2007, eq. 34, G1(l) G1(v).
template <typename Real>
Real VisibilitySeparable(Real n_dot_l, Real n_dot_v, Real alpha) {
  return 1 / ((n_dot_l + SmithRoot(n_dot_l, alpha)) * (n_dot_v + SmithRoot(n_dot_v, alpha)));
}

// k of Schlick's G1 in the two forms of Karis 2013, "Real Shading in Unreal Engine 4", where alpha
// is roughness^2 as here. k = alpha / 2 makes G1 as similar as possible to Smith's G1 of GGX, and
// is what he uses for image-based light; for analytic lights he replaces the roughness by
// (roughness + 1) / 2, so that k = (roughness + 1)^2 / 8. Texts that write alpha^2 / 2 for the
// former call the roughness alpha: it is roughness^2 / 2, not roughness^4 / 2.
template <typename Real>
Real SchlickK(Shadowing shadowing, Real roughness) {
  if (shadowing == Shadowing::kSchlickIbl) return AlphaFromRoughness(roughness) / 2;
  return (roughness + 1) * (roughness + 1) / 8;
}

// Schlick's G1(l) G1(v), G1(x) = n.x / (n.x (1 - k) + k), which is 1 for k = 0.
template <typename Real>
Real VisibilitySchlick(Real n_dot_l, Real n_dot_v, Real k) {
  return 1 / (4 * (n_dot_l * (1 - k) + k) * (n_dot_v * (1 - k) + k));
}

}  // namespace nacre
