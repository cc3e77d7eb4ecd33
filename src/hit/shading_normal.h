// SPDX-License-Identifier: Apache-2.0
// hit/shading_normal.h: clamps view directions and bends normal-mapped normals so that n.v >= 0 and
// mirror directions stay above the surface. SIMD twin: shading_normal-inl.h.
//
// For grazing views, an interpolated or normal-mapped normal may face away from the viewer, or
// reflect the view direction into the surface. Reflection models are not defined behind the shading
// normal: there they would gain or lose energy.
#pragma once

#include <cmath>

#include "base/vec.h"

namespace nacre {

// The least n.v that stays above 0 when the unit vectors are rounded to float. n.v = 0 itself could
// be rounded below 0, and then the mirror direction, whose n.l equals n.v, would lie behind the
// normal, where mirrors and sharp lobes are black.
inline constexpr double kMinViewCosine = 0x1p-22;

// An interpolated normal is that of the smooth surface that a mesh approximates. The parts of the
// smooth surface that face away are invisible, so triangles beyond its silhouette are shaded as the
// silhouette is: a view direction behind the normal is replaced by the grazing one of the same
// azimuth. The normal itself, on which light and shadows depend, is kept. A view direction straight
// behind the normal has no azimuth, and is replaced by the normal.
template <typename Real>
Imath::Vec3<Real> GrazingView(const Imath::Vec3<Real>& normal, const Imath::Vec3<Real>& to_view) {
  const Real least = static_cast<Real>(kMinViewCosine);
  const Real n_dot_v = normal ^ to_view;
  if (n_dot_v >= least) return to_view;
  const Imath::Vec3<Real> across = to_view - normal * (n_dot_v - least);
  return across * (1 / std::sqrt(across ^ across));
}

// A normal-mapped normal that faces away from the viewer, or reflects the view direction into the
// surface, is bent towards the viewer until the mirror direction lies along the surface: the result
// is the half vector of the view direction and of the mirror direction's projection on the surface
// (as in Keller et al. 2017, "The Iray Light Transport Simulation and Rendering System"). Other
// normals are returned bit for bit.
//
// All arguments are unit vectors. `surface` is the normal of the surface below the normal map, on
// the viewer's side; `normal` must lie on that side, too. The result has n.v >= 0, up to rounding,
// for all such inputs. It is continuous in them, except where the mirror direction goes straight
// into the surface.
inline Vec3d BendNormal(const Vec3d& normal, const Vec3d& surface, const Vec3d& to_view) {
  const double n_dot_v = normal ^ to_view;
  const Vec3d mirrored = normal * (2 * n_dot_v) - to_view;
  const double height = mirrored ^ surface;
  if (height >= 0 && n_dot_v >= 0) return normal;
  Vec3d along = mirrored - surface * height;
  // If the mirror direction goes straight into the surface, its projection is pure rounding error,
  // and all directions along the surface are equally near: the one that the normal leans to is
  // taken. 2^-60 is the square of 2^-30, where the projection's direction still has 22 of its 52
  // bits.
  if ((along ^ along) < 0x1p-60) along = normal - surface * (normal ^ surface);
  const Vec3d half = to_view + along * (1 / std::sqrt(along ^ along));
  const Vec3d bent = half * (1 / std::sqrt(half ^ half));
  // A view direction that lies in the surface's plane up to rounding may have no half vector.
  return (bent ^ to_view) >= 0 ? bent : surface;
}

}  // namespace nacre
