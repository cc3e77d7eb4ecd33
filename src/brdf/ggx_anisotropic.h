// SPDX-License-Identifier: Apache-2.0
// brdf/ggx_anisotropic.h: GGX with one alpha along the tangent and one across it: distribution,
// masking-shadowing, sampling of visible normals, and how formats of materials name the two alphas.
// SIMD twin: ggx_anisotropic-inl.h. Where both alphas are equal, every term is that of brdf/ggx.h
// or brdf/lobe_sampling.h up to rounding.
//
// The lobe's frame is a Basis: x is the tangent t, unit length and perpendicular to the shading
// normal, z is the shading normal n, and y is the bitangent b = n x t. Opposite tangents mean the
// same lobe.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "base/basis.h"
#include "brdf/angles.h"
#include "brdf/ggx.h"
#include "brdf/lobe_sampling.h"

namespace nacre {

// The widths of a lobe: alpha of slopes along the tangent and along the bitangent.
template <typename Real>
struct GgxAlphas {
  Real x = 0, y = 0;

  bool operator==(const GgxAlphas&) const = default;
};

// A delta lobe is narrow in both directions: no picture resolves it.
template <typename Real>
bool IsDeltaLobe(const GgxAlphas<Real>& alpha) {
  return IsDeltaLobe(alpha.x) && IsDeltaLobe(alpha.y);
}

// The alphas that the terms below expect. A lobe with one alpha below the limit of IsDeltaLobe is a
// streak, whose length a picture resolves and whose width it does not. A point light shows it where
// the half vector lies in the streak's plane, so it is no delta lobe, and it needs a width, because
// a width of 0 would make terms 0 / 0 in that plane. The smaller alpha is therefore raised to the
// limit, 2^-40: the streak looks the same, the peak 1 / (pi alpha.x alpha.y) stays within the range
// of float, and the albedo changes by far less than a rounding error. Alphas of a delta lobe
// are 0. Kernels whose directions are floats, off by 1e-7, need a wider limit of their own.
template <typename Real>
GgxAlphas<Real> MakeGgxAlphas(Real x, Real y) {
  const auto least = static_cast<Real>(kDeltaRoughness * kDeltaRoughness);
  if (IsDeltaLobe(x) && IsDeltaLobe(y)) return {};
  return {std::max(x, least), std::max(y, least)};
}

// The parameters of formats.

// The largest alpha that a format's mapping may return. OpenPBR 1.1 says that alphas are at most 1,
// but its formula reaches sqrt(2); MaterialX clamps, and others do not.
enum class AlphaLimit : uint8_t { kNone, kOne };

template <typename Real>
GgxAlphas<Real> LimitAlphas(Real x, Real y, AlphaLimit limit) {
  if (limit == AlphaLimit::kNone) return MakeGgxAlphas(x, y);
  return MakeGgxAlphas(std::min(x, Real(1)), std::min(y, Real(1)));
}

// OpenPBR 1.1, "Microfacet model": the mean of the squared alphas is that of the isotropic lobe,
// roughness^4, and alpha.y / alpha.x is 1 - anisotropy.
template <typename Real>
GgxAlphas<Real> OpenPbrAlphas(Real roughness, Real anisotropy, AlphaLimit limit) {
  const Real ratio = 1 - anisotropy;
  const Real x = AlphaFromRoughness(roughness) * std::sqrt(2 / (1 + ratio * ratio));
  return LimitAlphas(x, ratio * x, limit);
}

// KHR_materials_anisotropy: alpha.y is that of the isotropic lobe, and alpha.x is nearer to 1 by
// the square of the strength.
template <typename Real>
GgxAlphas<Real> GltfAlphas(Real roughness, Real strength) {
  const Real alpha = AlphaFromRoughness(roughness);
  return MakeGgxAlphas(alpha + (1 - alpha) * strength * strength, alpha);
}

// Both alphas from their geometric mean, roughness^2, and aspect = sqrt(alpha.y / alpha.x).
template <typename Real>
GgxAlphas<Real> AspectAlphas(Real roughness, Real aspect, AlphaLimit limit) {
  const Real alpha = AlphaFromRoughness(roughness);
  return LimitAlphas(alpha / aspect, alpha * aspect, limit);
}

// Autodesk's Standard Surface as MaterialX has it (roughness_anisotropy), with its limits for both
// anisotropy and alpha.
template <typename Real>
GgxAlphas<Real> StandardSurfaceAlphas(Real roughness, Real anisotropy,
                                      AlphaLimit limit = AlphaLimit::kOne) {
  const Real aspect = std::sqrt(1 - std::clamp(anisotropy, Real(0), static_cast<Real>(0.98)));
  return AspectAlphas(roughness, aspect, limit);
}

// Burley 2012, "Physically Based Shading at Disney", section 5.4, and Cycles' Principled BSDF.
template <typename Real>
GgxAlphas<Real> DisneyAlphas(Real roughness, Real anisotropy,
                             AlphaLimit limit = AlphaLimit::kNone) {
  return AspectAlphas(roughness, std::sqrt(1 - static_cast<Real>(0.9) * anisotropy), limit);
}

// A roughness, and OpenPBR's anisotropy or glTF's anisotropyStrength. Those of one format mean
// other alphas in another.
template <typename Real>
struct RoughnessAndAnisotropy {
  Real roughness = 0, anisotropy = 0;
};

// The parameters of these alphas, or nothing where a format has none: both need alpha.x >= alpha.y
// (else the tangent must be turned by a quarter), and glTF needs alpha.x <= 1.
template <typename Real>
std::optional<RoughnessAndAnisotropy<Real>> OpenPbrFromAlphas(const GgxAlphas<Real>& alpha) {
  if (!(alpha.x >= alpha.y)) return std::nullopt;
  if (!(alpha.x > 0)) return RoughnessAndAnisotropy<Real>{};
  const Real mean_square = (alpha.x * alpha.x + alpha.y * alpha.y) / 2;
  return RoughnessAndAnisotropy<Real>{std::sqrt(std::sqrt(mean_square)),
                                      (alpha.x - alpha.y) / alpha.x};
}
template <typename Real>
std::optional<RoughnessAndAnisotropy<Real>> GltfFromAlphas(const GgxAlphas<Real>& alpha) {
  if (!(alpha.x >= alpha.y) || !(alpha.x <= 1)) return std::nullopt;
  const Real strength2 = alpha.y < 1 ? (alpha.x - alpha.y) / (1 - alpha.y) : Real(0);
  return RoughnessAndAnisotropy<Real>{std::sqrt(alpha.y), std::sqrt(strength2)};
}

// The tangent turned about the normal.
template <typename Real>
struct Rotation {
  Real cos = 1, sin = 0;
};

// Whole quarters of a turn are exact.
template <typename Real>
Rotation<Real> RotationOfTurns(Real turns) {
  const Real quarters = std::nearbyint(turns * 4);
  const Real angle = 2 * static_cast<Real>(M_PI) * (turns - quarters / 4);
  const Real cos = std::cos(angle), sin = std::sin(angle);
  switch (static_cast<int>(std::remainder(quarters, Real(4)))) {
    case 0:
      return {cos, sin};
    case 1:
      return {-sin, cos};
    case -1:
      return {sin, -cos};
    default:
      return {-cos, -sin};
  }
}
template <typename Real>
Rotation<Real> RotationOfDegrees(Real degrees) {
  return RotationOfTurns(degrees / 360);
}

// Positive angles turn the tangent towards the bitangent: counter-clockwise for who looks at the
// surface from the side of its normal.
template <typename Real>
Imath::Vec3<Real> RotatedTangent(const Imath::Vec3<Real>& normal, const Imath::Vec3<Real>& tangent,
                                 const Rotation<Real>& rotation) {
  return tangent * rotation.cos + (normal % tangent) * rotation.sin;
}

// A tangent that need be neither unit length nor perpendicular to the normal, such as that of a
// mesh at a hit with a shading normal of its own, as the frame of a lobe: Gram and Schmidt's. A
// tangent along the normal has no direction: any perpendicular one takes its place.
template <typename Real>
Basis<Real> LobeFrame(const Imath::Vec3<Real>& normal, const Imath::Vec3<Real>& tangent) {
  // Dividing by the largest component keeps squares of short and long tangents in range.
  const Real largest = std::max({std::abs(tangent.x), std::abs(tangent.y), std::abs(tangent.z)});
  if (!(largest > 0) || !std::isfinite(largest)) return BasisAbout(normal);
  const Imath::Vec3<Real> scaled = tangent / largest;
  // Where little is left of the tangent, what is left is rounding error along the normal, too: the
  // second subtraction removes it.
  Imath::Vec3<Real> across = scaled - normal * (normal ^ scaled);
  across -= normal * (normal ^ across);
  const Real length2 = across.length2();
  const Real rounding = 8 * std::numeric_limits<Real>::epsilon();
  if (!(length2 > rounding * rounding)) return BasisAbout(normal);
  const Imath::Vec3<Real> x = across / std::sqrt(length2);
  return {x, normal % x, normal};
}

// The angles of brdf/angles.h, and the components along tangent and bitangent that anisotropic
// lobes add. Components of u are of u as it is corrected there.
template <typename Real>
struct FrameAngles : Angles<Real> {
  Real t_dot_u, b_dot_u;
  Real t_dot_l, b_dot_l;
  Real t_dot_v, b_dot_v;
};

template <typename Real>
FrameAngles<Real> ComputeAngles(const Basis<Real>& frame, const Imath::Vec3<Real>& l,
                                const Imath::Vec3<Real>& v) {
  const Imath::Vec3<Real> u = HalfSum(l, v);
  return {ComputeAngles(frame.z, l, v),
          frame.x ^ u,
          frame.y ^ u,
          frame.x ^ l,
          frame.y ^ l,
          frame.x ^ v,
          frame.y ^ v};
}

// Burley 2012, eq. 13, and Heitz 2014, eq. 85, of h = u / |u|:
// 1 / (pi ax ay ((t.h / ax)^2 + (b.h / ay)^2 + (n.h)^2)^2), with the sum times ax ay |u|^2, so that
// nothing is divided by a small square. 0 where h lies below the surface or is undefined, and for a
// delta lobe.
template <typename Real>
Real GgxDistribution(const FrameAngles<Real>& a, const GgxAlphas<Real>& alpha) {
  if (IsDeltaLobe(alpha) || !(a.n_dot_u > 0)) return 0;
  const Real x = a.t_dot_u * alpha.y, y = a.b_dot_u * alpha.x;
  const Real denominator = x * (a.t_dot_u / alpha.x) + y * (a.b_dot_u / alpha.y) +
                           (a.n_dot_u * alpha.x) * (a.n_dot_u * alpha.y);
  if (!(denominator > 0)) return 0;  // u underflowed: l = -v to working precision
  const Real k = a.u_squared / denominator;
  return (alpha.x * k) * (alpha.y * k) / static_cast<Real>(M_PI);
}

// n.x times sqrt(1 + alpha^2 tan^2), with the alpha that x sees, of Heitz 2014, eq. 80:
// alpha^2 sin^2 = (ax t.x)^2 + (ay b.x)^2.
template <typename Real>
Real SmithRoot(Real n_dot_x, Real t_dot_x, Real b_dot_x, const GgxAlphas<Real>& alpha) {
  const Real x = alpha.x * t_dot_x, y = alpha.y * b_dot_x;
  return std::sqrt(n_dot_x * n_dot_x + (x * x + y * y));
}
template <typename Real>
Real SmithRootOfLight(const FrameAngles<Real>& a, const GgxAlphas<Real>& alpha) {
  return SmithRoot(a.n_dot_l, a.t_dot_l, a.b_dot_l, alpha);
}
// An n.v below 0 counts as 0.
template <typename Real>
Real SmithRootOfView(const FrameAngles<Real>& a, const GgxAlphas<Real>& alpha) {
  return SmithRoot(std::max(a.n_dot_v, Real(0)), a.t_dot_v, a.b_dot_v, alpha);
}

// The visibility terms V = G / (4 n.l n.v), for n.l > 0 and no delta lobe. An n.v below 0 counts
// as 0. Height-correlated Smith: Heitz 2014, eq. 99.
template <typename Real>
Real VisibilityHeightCorrelated(const FrameAngles<Real>& a, const GgxAlphas<Real>& alpha) {
  const Real n_dot_v = std::max(a.n_dot_v, Real(0));
  return 1 / (2 * (a.n_dot_l * SmithRootOfView(a, alpha) + n_dot_v * SmithRootOfLight(a, alpha)));
}

// Separable Smith: Walter et al. 2007, eq. 23, G1(l) G1(v).
template <typename Real>
Real VisibilitySeparable(const FrameAngles<Real>& a, const GgxAlphas<Real>& alpha) {
  const Real n_dot_v = std::max(a.n_dot_v, Real(0));
  return 1 / ((a.n_dot_l + SmithRootOfLight(a, alpha)) * (n_dot_v + SmithRootOfView(a, alpha)));
}

// Samples the direction to light (SampleGgxHalf).
template <typename Real>
Imath::Vec3<Real> SampleGgxVisible(const Basis<Real>& frame, const Imath::Vec3<Real>& to_view,
                                   const GgxAlphas<Real>& alpha, Real u0, Real u1) {
  if (IsDeltaLobe(alpha)) return Mirrored(to_view, frame.z);
  const Imath::Vec3<Real> v = frame.ToLocal(to_view);
  return Mirrored(to_view, frame.ToWorld(SampleGgxHalf(v, alpha.x, alpha.y, u0, u1)));
}

// D(h) G1(v) / (4 n.v) = D / (2 (n.v + root)), finite at grazing angles. 0 for a delta lobe.
template <typename Real>
Real GgxVisiblePdf(const FrameAngles<Real>& a, const GgxAlphas<Real>& alpha) {
  if (IsDeltaLobe(alpha)) return 0;
  const Real n_dot_v = std::max(a.n_dot_v, Real(0));
  return GgxDistribution(a, alpha) / (2 * (n_dot_v + SmithRootOfView(a, alpha)));
}

}  // namespace nacre
