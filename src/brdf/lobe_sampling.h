// SPDX-License-Identifier: Apache-2.0
// brdf/lobe_sampling.h: directions to light sampled from the lobes of reflection models. SIMD twin:
// lobe_sampling-inl.h.
//
// Every lobe has a sampler, which takes u0 and u1 in [0, 1), and the pdf of its directions per
// solid angle. A sampled direction may lie below the surface, where models reflect nothing; pdfs
// are valid there, too, and integrate to 1 over the whole sphere unless stated otherwise.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/basis.h"
#include "brdf/albedo_curve.h"
#include "brdf/ggx.h"
#include "brdf/phong.h"

namespace nacre {

// Cosine-weighted, for diffuse reflection: a uniform disk lifted to the hemisphere (Malley's
// method).
template <typename Real>
Imath::Vec3<Real> SampleCosine(const Imath::Vec3<Real>& normal, Real u0, Real u1) {
  const PointOnDisk<Real> p = ConcentricDisk(u0, u1);
  return BasisAbout(normal).ToWorld({p.x, p.y, std::sqrt((1 - p.radius) * (1 + p.radius))});
}

template <typename Real>
Real CosinePdf(Real n_dot_l) {
  return n_dot_l > 0 ? n_dot_l / static_cast<Real>(M_PI) : 0;
}

// Samples visible GGX normals and mirrors v about them: Dupuy and Benyoub 2023, "Sampling Visible
// GGX Normals with Spherical Caps". With the surface squeezed by alpha, the normals are those of a
// hemisphere, and the mirror directions of the part that v sees fill the cap above -v uniformly. A
// delta lobe gives the mirror direction. An n.v that rounding makes negative counts as 0, the limit
// for grazing viewers, here, in the pdf and in the reflection models. SampleGgxHalf samples the
// half vector in the lobe's frame, where `v` is the viewer; the squeeze is by an alpha along each
// axis.
template <typename Real>
Imath::Vec3<Real> SampleGgxHalf(const Imath::Vec3<Real>& v, Real alpha_x, Real alpha_y, Real u0,
                                Real u1) {
  const Imath::Vec3<Real> scaled(alpha_x * v.x, alpha_y * v.y, std::max(v.z, Real(0)));
  // The length is above 0 except for v = -n, which has no azimuth: samples are then distributed
  // evenly about n.
  const Real length = std::max(scaled.length(), std::numeric_limits<Real>::min());
  const Imath::Vec3<Real> squeezed = scaled / length;
  const Real phi = 2 * static_cast<Real>(M_PI) * u0;
  // A point of the cap has z in [-squeezed.z, 1]. 1 - z, 1 + z and half_z, the z of the half vector
  // before it is normalised, are computed without cancellation, because they form the lobe's tail.
  const Real half_z = (1 - u1) * (1 + squeezed.z);
  const Real one_minus_z = u1 * (1 + squeezed.z);
  const Real across_squared = scaled.x * scaled.x + scaled.y * scaled.y;
  const Real one_plus_z = half_z + across_squared / std::max(length * (length + scaled.z),
                                                             std::numeric_limits<Real>::min());
  const Real sin = std::sqrt(one_minus_z * one_plus_z);
  const Imath::Vec3<Real> half(alpha_x * (sin * std::cos(phi) + squeezed.x),
                               alpha_y * (sin * std::sin(phi) + squeezed.y), half_z);
  return half.normalized();
}

// Samples the direction to light of an isotropic lobe.
template <typename Real>
Imath::Vec3<Real> SampleGgxVisible(const Imath::Vec3<Real>& normal,
                                   const Imath::Vec3<Real>& to_view, Real alpha, Real u0, Real u1) {
  if (IsDeltaLobe(alpha)) return Mirrored(to_view, normal);
  const Basis<Real> basis = BasisAbout(normal);
  const Imath::Vec3<Real> half = SampleGgxHalf(basis.ToLocal(to_view), alpha, alpha, u0, u1);
  return Mirrored(to_view, basis.ToWorld(half));
}

// D(h) G1(v) / (4 n.v) = D / (2 (n.v + root)), finite at grazing angles. 0 for a delta lobe.
template <typename Real>
Real GgxVisiblePdf(const Angles<Real>& a, Real alpha) {
  if (IsDeltaLobe(alpha)) return 0;
  const Real n_dot_v = std::max(a.n_dot_v, Real(0));
  return GgxDistribution(a, alpha) / (2 * (n_dot_v + SmithRoot(n_dot_v, alpha)));
}

template <typename Real>
Real GgxVisiblePdf(const Imath::Vec3<Real>& normal, const Imath::Vec3<Real>& to_view,
                   const Imath::Vec3<Real>& to_light, Real alpha) {
  return GgxVisiblePdf(ComputeAngles(normal, to_light, to_view), alpha);
}

// The lobe of Kulla and Conty 2017, as a function of the direction to light, is proportional to
// (1 - E(n.l)) n.l. The loss 1 - E is flat up to an n.l of about sqrt(spread), twice the width of
// the lobe or of Schlick's masking, and then falls as 1 / (n.l)^2, so the pdf per solid angle is
// proportional to n.l / ((n.l)^2 + spread). With this spread, lobe over pdf is 1.9 at most and 1.04
// rms, relative to the mean, at every roughness. The loss of kSchlickIbl falls as alpha / n.l only:
// with a spread of alpha, the figures are 3.5 and 1.25 at roughness 0.01, and less above. A smooth
// surface loses light at its horizon alone, which cosine-weighted directions hardly ever reach.
//
// n.l / ((n.l)^2 + spread) integrates to pi L over the hemisphere, L = log(1 + 1 / spread), and the
// fraction of this below n.l is u = log(1 + (n.l)^2 / spread) / L.
inline float KullaContySpread(const AlbedoShape& shape) {
  if (shape.form == AlbedoForm::kLossLinear) return shape.offset / 6;  // alpha
  const float twice_width = shape.form == AlbedoForm::kMasked ? 2 * shape.k : shape.offset / 3;
  return twice_width * twice_width;
}

template <typename Real>
Imath::Vec3<Real> SampleKullaConty(const Imath::Vec3<Real>& normal, Real spread, Real u0, Real u1) {
  const Real squared = std::min(spread * std::expm1(u0 * std::log1p(1 / spread)), Real(1));
  const Real sin = std::sqrt(1 - squared);
  const Real phi = 2 * static_cast<Real>(M_PI) * u1;
  return BasisAbout(normal).ToWorld({sin * std::cos(phi), sin * std::sin(phi), std::sqrt(squared)});
}

template <typename Real>
Real KullaContyPdf(Real n_dot_l, Real spread) {
  if (!(n_dot_l > 0)) return 0;
  const Real total = static_cast<Real>(M_PI) * std::log1p(1 / spread);
  return n_dot_l / ((n_dot_l * n_dot_l + spread) * total);
}

// Below this exponent Phong's lobe is constant over the whole sphere: c^0 is 1 everywhere, and in
// float any smaller exponent acts as 0 (kDarkLog2 in phong-inl.h).
inline constexpr double kConstantLobeExponent = 0x1p-88;

// 1 - cos of an angle whose pdf per solid angle is proportional to cos^shininess:
// cos^(shininess + 1) is 1 - u0.
template <typename Real>
Real OneMinusPowerCosine(Real shininess, Real u0) {
  return -std::expm1(std::log1p(-u0) / (shininess + 1));
}

// Samples Phong's lobe around the mirror direction of v, or all directions uniformly where the lobe
// is constant.
template <typename Real>
Imath::Vec3<Real> SamplePhongLobe(const Imath::Vec3<Real>& normal, const Imath::Vec3<Real>& to_view,
                                  Real shininess, Real u0, Real u1) {
  const bool constant = shininess < static_cast<Real>(kConstantLobeExponent);
  const Real x = constant ? 2 * u0 : OneMinusPowerCosine(shininess, u0);
  return DirectionAround(Mirrored(to_view, normal), x, u1);
}

template <typename Real>
Real PhongLobePdf(const Imath::Vec3<Real>& normal, const Imath::Vec3<Real>& to_view,
                  const Imath::Vec3<Real>& to_light, Real shininess) {
  if (shininess < static_cast<Real>(kConstantLobeExponent)) {
    return 1 / (4 * static_cast<Real>(M_PI));
  }
  return (shininess + 1) / (2 * static_cast<Real>(M_PI)) *
         PhongLobe(normal, to_light, to_view, shininess);
}

// Samples Blinn's lobe: half vectors around the normal, about which v is mirrored. A half vector
// that faces away from v makes an invalid sample: its direction has pdf 0, and the pdf integrates
// to the probability of the valid ones.
template <typename Real>
Imath::Vec3<Real> SampleBlinnLobe(const Imath::Vec3<Real>& normal, const Imath::Vec3<Real>& to_view,
                                  Real shininess, Real u0, Real u1) {
  return Mirrored(to_view, DirectionAround(normal, OneMinusPowerCosine(shininess, u0), u1));
}

// (n + 1) / (2 pi) (n.h)^n / (4 v.h), with v.h = |u| / 2.
template <typename Real>
Real BlinnLobePdf(const Imath::Vec3<Real>& normal, const Imath::Vec3<Real>& to_view,
                  const Imath::Vec3<Real>& to_light, Real shininess) {
  const Angles<Real> a = ComputeAngles(normal, to_light, to_view);
  if (!(a.n_dot_u > 0) || !(a.u_squared > 0)) return 0;
  return (shininess + 1) / (4 * static_cast<Real>(M_PI)) * BlinnLobe(a, shininess) /
         std::sqrt(a.u_squared);
}

}  // namespace nacre
