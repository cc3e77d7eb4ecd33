// SPDX-License-Identifier: Apache-2.0
// brdf/measured.h: what a measured BRDF reflects, and directions sampled by it. SIMD twin:
// measured-inl.h.
//
// `lobe` is the surface's frame: z is the normal; x and y, tangent and bitangent, are read of
// anisotropic BRDFs alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <variant>

#include "brdf/lobe_sampling.h"
#include "brdf/merl.h"
#include "brdf/rgl.h"

namespace nacre {

// f(l, v) n.l; 0 unless both directions are above the surface.
inline Rgb EvaluateMeasured(const MeasuredBrdf& brdf, MeasuredInterpolation interpolation,
                            const Basis<double>& lobe, const Vec3d& l, const Vec3d& v) {
  const double n_dot_l = lobe.z ^ l;
  if (!(n_dot_l > 0) || !((lobe.z ^ v) > 0)) return Rgb(0, 0, 0);
  if (const auto* const merl = std::get_if<MerlTable>(&brdf.table)) {
    return EvaluateMerl(*merl, interpolation, lobe.z, l, v) * n_dot_l;
  }
  const Basis<double> frame = MeasuredFrame(brdf, lobe, v);
  return EvaluateRgl(brdf, std::get<RglTable>(brdf.table), frame.ToLocal(l), frame.ToLocal(v));
}

// The share of samples that are cosine-weighted: between the nodes of its tables, the density of
// half vectors may be 0 where light is reflected.
inline constexpr double kMeasuredCosineShare = 0.125;

// The solid angle of half vectors over the area of the square is 2 pi^2 x sin(theta): 0 at the
// normal, where a density over the square would have none per solid angle.
inline constexpr double kLeastSquareJacobian = 1e-6;
inline double SquareJacobian(double x, double sin_theta) {
  return std::max(2 * M_PI * M_PI * x * sin_theta, kLeastSquareJacobian);
}

// Samples half vectors by the tabulated densities, about which v is mirrored, or, in
// kMeasuredCosineShare of the cases, cosine-weighted directions.
inline Vec3d SampleMeasured(const MeasuredBrdf& brdf, const Basis<double>& lobe, const Vec3d& v,
                            double u0, double u1) {
  if (u0 < kMeasuredCosineShare) return SampleCosine(lobe.z, u0 / kMeasuredCosineShare, u1);
  const Basis<double> frame = MeasuredFrame(brdf, lobe, v);
  const Slices slices = ViewerOf(brdf, frame.ToLocal(v)).slices;
  SquarePoint p{(u0 - kMeasuredCosineShare) / (1 - kMeasuredCosineShare), u1};
  if (!brdf.luminance.empty()) p = WarpForward(brdf.luminance, slices, p);
  p = WarpForward(brdf.half, slices, p);
  const double theta = p.x * p.x * M_PI_2, phi = (2 * p.y - 1) * M_PI, sin = std::sin(theta);
  return Mirrored(v, frame.ToWorld({sin * std::cos(phi), sin * std::sin(phi), std::cos(theta)}));
}

inline double MeasuredPdf(const MeasuredBrdf& brdf, const Basis<double>& lobe, const Vec3d& v,
                          const Vec3d& l) {
  const double cosine = kMeasuredCosineShare * CosinePdf(lobe.z ^ l);
  const Basis<double> frame = MeasuredFrame(brdf, lobe, v);
  const Vec3d local_l = frame.ToLocal(l), local_v = frame.ToLocal(v);
  const Vec3d u = HalfSum(local_l, local_v);
  const double length = u.length();
  if (!(u.z > 0) || !(length > 0)) return cosine;
  const Slices slices = ViewerOf(brdf, local_v).slices;
  const SquarePoint half = HalfSquare(local_l, local_v);
  double density = WarpDensity(brdf.half, slices, half);
  if (!brdf.luminance.empty()) {
    density *= WarpDensity(brdf.luminance, slices, WarpInverse(brdf.half, slices, half));
  }
  // 4 v.h = 2 |u|.
  const double sin = std::hypot(u.x, u.y) / length;
  return cosine + (1 - kMeasuredCosineShare) * density / (SquareJacobian(half.x, sin) * 2 * length);
}

// The directional albedo for a viewer at n.v, between tabulated angles.
inline Rgb MeasuredAlbedo(const MeasuredBrdf& brdf, double n_dot_v) {
  const double angle = std::acos(std::clamp(n_dot_v, 0.0, 1.0));
  const BetweenNodes at = FindNode(kAlbedoAngles, angle / M_PI_2);
  return brdf.albedo[at.index] * (1 - at.fraction) + brdf.albedo[at.index + 1] * at.fraction;
}

}  // namespace nacre
