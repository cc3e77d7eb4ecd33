// SPDX-License-Identifier: Apache-2.0
// light/area_sample.h: what all area lights have, and a direction sampled towards one. The lights
// themselves are in {sphere,rectangle,disk,triangle}_light.h, the irradiance of rectangles and
// triangles in polygon_irradiance.h. SIMD twin: area_sample-inl.h.
//
// A light's geometry is relative to the shaded point: its centre or corner is the offset from the
// point, which the caller computes in double before rounding. Edges and radii are given separately,
// so that they keep their digits at any distance. The float forms divide all lengths by a power of
// two first, so that products of them stay in range for every valid scene (scene/limits.h).
//
// Every light has
//   AreaSample SampleLight(light, u0, u1)    for u0 and u1 in [0, 1)
//   Real       LightPdf(light, direction)    the pdf of sampling it; 0 if it misses the light
//   Real       SolidAngle(light)             for disks by quadrature, in double only
//   Real       Irradiance(light, normal)     per unit of radiance
// Pdfs are per solid angle. Samples are uniform in solid angle, unless a light's file says
// otherwise. The radiance that leaves towards the point is up to the caller; the sign of cos_light
// tells which side faces the point.
//
// The irradiance is that of a surface under the unoccluded light of uniform radiance, in closed
// form, clipped at the surface's horizon; pi where light comes from everywhere. `normal` is unit
// length. Both faces of a flat light and both sides of a sphere count as emitting; the caller
// checks which ones do. In a flat light's own plane the irradiance is 0. In float the error is a
// few roundings of the result, plus the effect of rounding the inputs (of heights over the horizon,
// for lights that barely rise above it), and for polygons a few roundings of the result times
// length over width.
#pragma once

#include "base/vec.h"

namespace nacre {

template <typename Real>
struct AreaSample {
  Imath::Vec3<Real> to_light{0, 0, 0};  // unit length
  Real distance = 0;                    // to the light's first surface in that direction
  Real inverse_pdf = 0;                 // solid-angle measure; 0: no sample
  Real cos_light = 0;                   // between the light's outward normal and -to_light
};

// Flat lights of smaller solid angles are sampled uniformly in area, not in solid angle: there the
// pdf per solid angle hardly varies over the light, unless it is seen edge-on, and differences of
// angles would have lost their digits.
template <typename Real>
inline constexpr Real kSmallSolidAngle = static_cast<Real>(1e-4);

}  // namespace nacre
