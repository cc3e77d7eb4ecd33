// SPDX-License-Identifier: Apache-2.0
// brdf/lobe_sampling.h: directions to light sampled from the lobes of reflection models. SIMD twin:
// lobe_sampling-inl.h.
//
// Every lobe has a sampler, of u0 and u1 in [0, 1), and the density of what it gives per solid
// angle. A sampled direction may lie below the surface, where models reflect nothing; densities
// hold there too, and integrate to 1 over the whole sphere unless a lobe says otherwise.
#pragma once

#include <cmath>

#include "base/basis.h"
#include "base/concentric_disk.h"
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

// GGX normals as far as the viewer sees them, mirrored: Dupuy and Benyoub 2023, "Sampling Visible
// GGX Normals with Spherical Caps". With the surface squeezed by alpha the normals are those of a
// hemisphere, and the mirror directions of what v sees of it fill the cap above -v evenly. v must
// be above the surface. A delta lobe gives the mirror direction.
template <typename Real>
Imath::Vec3<Real> SampleGgxVisible(const Imath::Vec3<Real>& normal,
                                   const Imath::Vec3<Real>& to_view, Real alpha, Real u0, Real u1) {
  if (IsDeltaLobe(alpha)) return Mirrored(to_view, normal);
  const Basis<Real> basis = BasisAbout(normal);
  const Imath::Vec3<Real> v = basis.ToLocal(to_view);
  const Imath::Vec3<Real> scaled(alpha * v.x, alpha * v.y, v.z);
  const Real length = scaled.length();
  const Imath::Vec3<Real> squeezed = scaled / length;
  const Real phi = 2 * static_cast<Real>(M_PI) * u0;
  // A point of the cap, z in [-squeezed.z, 1]: 1 - z, and 1 + z and the z of the half vector of
  // both free of cancellation, for they make the lobe's tail.
  const Real half_z = (1 - u1) * (1 + squeezed.z);
  const Real one_minus_z = u1 * (1 + squeezed.z);
  const Real one_plus_z =
      half_z + (scaled.x * scaled.x + scaled.y * scaled.y) / (length * (length + scaled.z));
  const Real sin = std::sqrt(one_minus_z * one_plus_z);
  const Imath::Vec3<Real> half(alpha * (sin * std::cos(phi) + squeezed.x),
                               alpha * (sin * std::sin(phi) + squeezed.y), half_z);
  return Mirrored(to_view, basis.ToWorld(half.normalized()));
}

// D(h) G1(v) / (4 n.v) = D / (2 (n.v + root)), finite at grazing angles. 0 for a delta lobe.
template <typename Real>
Real GgxVisiblePdf(const Angles<Real>& a, Real alpha) {
  if (!(a.n_dot_v > 0)) return 0;
  return GgxDistribution(a, alpha) / (2 * (a.n_dot_v + SmithRoot(a.n_dot_v, alpha)));
}

template <typename Real>
Real GgxVisiblePdf(const Imath::Vec3<Real>& normal, const Imath::Vec3<Real>& to_view,
                   const Imath::Vec3<Real>& to_light, Real alpha) {
  return GgxVisiblePdf(ComputeAngles(normal, to_light, to_view), alpha);
}

// BRDF n.l / density for height-correlated shadowing and a Fresnel term of 1: G2 / G1, at most 1.
// Neither needs D, which carries the roundings of the sample's direction.
template <typename Real>
Real GgxVisibleWeight(Real n_dot_l, Real n_dot_v, Real alpha) {
  if (!(n_dot_l > 0) || !(n_dot_v > 0)) return 0;
  const Real v_root = SmithRoot(n_dot_v, alpha);
  return n_dot_l * (n_dot_v + v_root) / (n_dot_l * v_root + n_dot_v * SmithRoot(n_dot_l, alpha));
}

// A direction around `axis` with a density of cos^shininess: cos^(shininess + 1) = 1 - u0.
template <typename Real>
Imath::Vec3<Real> SampleCosinePower(const Imath::Vec3<Real>& axis, Real shininess, Real u0,
                                    Real u1) {
  const Real x = -std::expm1(std::log1p(-u0) / (shininess + 1));  // 1 - cos
  const Real sin = std::sqrt(x * (2 - x));
  const Real phi = 2 * static_cast<Real>(M_PI) * u1;
  return BasisAbout(axis).ToWorld({sin * std::cos(phi), sin * std::sin(phi), 1 - x});
}

// Phong's lobe, around the mirror direction of v.
template <typename Real>
Imath::Vec3<Real> SamplePhongLobe(const Imath::Vec3<Real>& normal, const Imath::Vec3<Real>& to_view,
                                  Real shininess, Real u0, Real u1) {
  return SampleCosinePower(Mirrored(to_view, normal), shininess, u0, u1);
}

template <typename Real>
Real PhongLobePdf(const Imath::Vec3<Real>& normal, const Imath::Vec3<Real>& to_view,
                  const Imath::Vec3<Real>& to_light, Real shininess) {
  // An exponent of 0 is 1 on both sides for the model; the sampler takes one.
  if (!((Mirrored(to_view, normal) ^ to_light) > 0)) return 0;
  return (shininess + 1) / (2 * static_cast<Real>(M_PI)) *
         PhongLobe(normal, to_light, to_view, shininess);
}

// Blinn's lobe: half vectors around the normal, and v mirrored about them. A half vector that faces
// away from v is no sample: its direction has density 0, and the density integrates to the rest.
template <typename Real>
Imath::Vec3<Real> SampleBlinnLobe(const Imath::Vec3<Real>& normal, const Imath::Vec3<Real>& to_view,
                                  Real shininess, Real u0, Real u1) {
  return Mirrored(to_view, SampleCosinePower(normal, shininess, u0, u1));
}

// (n + 1) / (2 pi) (n.h)^n / (4 v.h), with v.h = |u| / 2.
template <typename Real>
Real BlinnLobePdf(const Angles<Real>& a, Real shininess) {
  if (!(a.n_dot_u > 0) || !(a.u_squared > 0)) return 0;
  return (shininess + 1) / (4 * static_cast<Real>(M_PI)) * BlinnLobe(a, shininess) /
         std::sqrt(a.u_squared);
}

template <typename Real>
Real BlinnLobePdf(const Imath::Vec3<Real>& normal, const Imath::Vec3<Real>& to_view,
                  const Imath::Vec3<Real>& to_light, Real shininess) {
  return BlinnLobePdf(ComputeAngles(normal, to_light, to_view), shininess);
}

}  // namespace nacre
