// SPDX-License-Identifier: Apache-2.0
// brdf/rgl.h: looks up a table of EPFL's database, and the unit square of half vectors by which all
// measured BRDFs are sampled. SIMD twin: rgl-inl.h.
//
// Dupuy and Jakob 2018, section 4. The square: x = sqrt(2 theta / pi), so that nodes are dense
// around the normal, and y = (phi + pi) / (2 pi).
#pragma once

#include <algorithm>
#include <cmath>

#include "brdf/angles.h"
#include "brdf/ggx_anisotropic.h"
#include "brdf/measured_table.h"

namespace nacre {

inline SquarePoint SquareOf(double theta, double phi) {
  return {std::sqrt(theta / M_PI_2), (phi + M_PI) / (2 * M_PI)};
}

inline double ThetaOf(const Vec3d& local) {
  return std::atan2(std::hypot(local.x, local.y), local.z);
}

// Half vectors of isotropic BRDFs have their azimuths from the viewer's.
//
// The frame in which tables are looked up, for a viewer: its x axis is towards the viewer's
// projection or, of an anisotropic BRDF, along the tangent. Where measurements cover a half or a
// quarter of the azimuths, the axes' signs are such that the viewer is among them, from -pi on.
inline Basis<double> MeasuredFrame(const MeasuredBrdf& brdf, const Basis<double>& lobe,
                                   const Vec3d& to_view) {
  if (brdf.isotropic) return LobeFrame(lobe.z, to_view);
  Basis<double> frame = lobe;
  if (brdf.reduction < 2) return frame;
  const double y = lobe.y ^ to_view, x = brdf.reduction == 4 ? lobe.x ^ to_view : y;
  if (x > 0) frame.x = -frame.x;
  if (y > 0) frame.y = -frame.y;
  return frame;
}

// A viewer in that frame.
struct MeasuredViewer {
  double theta, phi;
  Slices slices;
};
inline MeasuredViewer ViewerOf(const MeasuredBrdf& brdf, const Vec3d& local) {
  MeasuredViewer viewer{ThetaOf(local), 0, {}};
  if (!brdf.isotropic) viewer.phi = std::atan2(local.y, local.x);
  viewer.slices = SlicesAt(brdf.half.angles, viewer.phi, viewer.theta);
  return viewer;
}

// The half vector of local directions as a point of the square. x is above 1 if it is below the
// surface.
inline SquarePoint HalfSquare(const Vec3d& l, const Vec3d& v) {
  const Vec3d u = HalfSum(l, v);
  return SquareOf(ThetaOf(u), std::atan2(u.y, u.x));
}

// f(l, v) n.l of local directions above the surface.
inline Rgb EvaluateRgl(const MeasuredBrdf& brdf, const RglTable& table, const Vec3d& l,
                       const Vec3d& v) {
  const MeasuredViewer viewer = ViewerOf(brdf, v);
  const SquarePoint half = HalfSquare(l, v);
  const SquarePoint s = WarpInverse(brdf.half, viewer.slices, half);
  const auto in_square = [](const SquareTable& of, const SquarePoint& p) {
    return BilinearOfSlices({{}, {1}, 1}, of.values, 0, 0, of.width, of.height, p.x, p.y);
  };
  double scale = 1;
  if (table.jacobian) {
    const double sigma = in_square(table.sigma, SquareOf(viewer.theta, viewer.phi));
    scale = sigma > 0 ? in_square(table.ndf, half) / (4 * sigma) : 0;
  }
  const size_t nodes = table.size * table.size;
  return MakeRgb([&](int c) {
    return scale * BilinearOfSlices(viewer.slices, table.rgb, 3 * nodes,
                                    static_cast<size_t>(c) * nodes, table.size, table.size, s.x,
                                    s.y);
  });
}

}  // namespace nacre
