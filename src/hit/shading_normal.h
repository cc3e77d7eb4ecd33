// SPDX-License-Identifier: Apache-2.0
// hit/shading_normal.h: clamps view directions and bends normal-mapped normals so that n.v >= 0 and
// mirror directions stay above the surface. SIMD twin: shading_normal-inl.h.
//
// Interpolated and mapped normals can lean so far from a viewer who grazes the surface that the
// viewer is behind them, or mirrors into the surface. No reflection model is defined behind its
// normal, and what it would do there is to make light or to lose it.
#pragma once

#include <cmath>

#include "base/vec.h"

namespace nacre {

// The least n.v that unit vectors rounded to float keep above 0. The limit, n.v = 0, would not do:
// it may be rounded to below 0, and the mirror direction, whose n.l is n.v, lies behind the normal
// then, where mirrors and narrow lobes are black.
inline constexpr double kLeastViewCosine = 0x1p-22;

// An interpolated normal is that of the smooth surface that a mesh stands for, of which a viewer
// cannot see what faces away: beyond the smooth outline triangles show what the outline does. A
// viewer behind the normal counts as the one who grazes the smooth surface in the same azimuth; the
// normal, which light and shadows ask for, stays. A viewer straight behind has no azimuth, and
// counts as one straight above.
template <typename Real>
Imath::Vec3<Real> GrazingView(const Imath::Vec3<Real>& normal, const Imath::Vec3<Real>& to_view) {
  const Real least = static_cast<Real>(kLeastViewCosine);
  const Real n_dot_v = normal ^ to_view;
  if (n_dot_v >= least) return to_view;
  const Imath::Vec3<Real> across = to_view - normal * (n_dot_v - least);
  return across * (1 / std::sqrt(across ^ across));
}

// A mapped normal whose viewer is behind it, or mirrors into the surface, is bent towards the
// viewer until the mirror direction lies along the surface: the half vector of the viewer and
// of the mirror direction's projection on the surface (Keller et al. 2017, "The Iray Light
// Transport Simulation and Rendering System", do the same). Other normals keep their bits.
//
// All are unit vectors; `surface` is the normal of the surface that the shading normal belongs to,
// on the viewer's side, and the shading normal lies on that side, too. Of the result n.v >= 0, but
// for rounding, whatever they are. It is continuous in all of them, but for a viewer who mirrors
// straight down into the surface.
inline Vec3d BendNormal(const Vec3d& normal, const Vec3d& surface, const Vec3d& to_view) {
  const double n_dot_v = normal ^ to_view;
  const Vec3d mirrored = normal * (2 * n_dot_v) - to_view;
  const double height = mirrored ^ surface;
  if (height >= 0 && n_dot_v >= 0) return normal;
  Vec3d along = mirrored - surface * height;
  // Straight down, nothing but rounding is left of it, and every direction along the surface is as
  // near: the one that the normal leans to. 2^-60: the square of 2^-30, where the direction of what
  // is left still has 22 of its 52 digits.
  if ((along ^ along) < 0x1p-60) along = normal - surface * (normal ^ surface);
  const Vec3d half = to_view + along * (1 / std::sqrt(along ^ along));
  const Vec3d bent = half * (1 / std::sqrt(half ^ half));
  // A viewer in the surface's own plane, to the last digit, may leave no half vector.
  return (bent ^ to_view) >= 0 ? bent : surface;
}

}  // namespace nacre
