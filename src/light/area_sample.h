// SPDX-License-Identifier: Apache-2.0
// light/area_sample.h: a direction sampled towards an area light. The lights themselves:
// {sphere,rectangle,disk,triangle}_light.h. SIMD twin: area_sample-inl.h.
//
// A light's geometry is relative to the shaded point: its centre, or corner, is the offset from
// there, which the caller forms in double before it rounds. Edges and radii are the light's own,
// so that they keep their digits at any distance. Float forms divide them by a power of two first,
// so that products of them stay in range for all that a scene may hold (scene/limits.h).
//
// Every light has
//   AreaSample SampleLight(light, u0, u1)    for u0 and u1 in [0, 1)
//   Real       LightPdf(light, direction)    the pdf of that sample: 0 if it misses the light
//   Real       SolidAngle(light)             a disk's by quadrature, in double only
// Pdfs are per solid angle. Samples are uniform in solid angle, unless a light's file says
// otherwise. What radiance leaves towards the point is the caller's to say; the sign of cos_light
// tells the two sides apart.
#pragma once

#include "base/vec.h"

namespace nacre {

template <typename Real>
struct AreaSample {
  Imath::Vec3<Real> to_light{0, 0, 0};  // unit length
  Real distance = 0;                    // to the light's first surface that way
  Real inverse_pdf = 0;                 // solid-angle measure; 0: no sample
  Real cos_light = 0;                   // of the light's outward normal towards the point
};

// Solid angles below which flat lights are sampled by area, not by solid angle: there the pdf
// per solid angle hardly varies over the light, unless it is seen edge-on, and differences of
// angles have lost their digits.
template <typename Real>
inline constexpr Real kSmallSolidAngle = static_cast<Real>(1e-4);

}  // namespace nacre
