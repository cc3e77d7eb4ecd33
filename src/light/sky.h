// SPDX-License-Identifier: Apache-2.0
// light/sky.h: analytic skies, with the irradiance of an unoccluded surface in closed form. Each
// struct holds one colour channel. SIMD twin: sky-inl.h.
#pragma once

#include <cmath>

#include "base/vec.h"

namespace nacre {

// The radiance is linear in the height of the direction, from the horizon up to the zenith and down
// to the ground.
template <typename Real>
struct GradientSkyTerms {
  Real zenith, horizon, ground;
};

template <typename Real>
Real Radiance(const GradientSkyTerms<Real>& sky, const Imath::Vec3<Real>& direction) {
  const Real other = direction.y > 0 ? sky.zenith : sky.ground;
  return sky.horizon + (other - sky.horizon) * std::abs(direction.y);
}

// The integral of the product of two clamped cosines whose axes are at the angle t is
// 2/3 (sin t + (pi - t) cos t).
template <typename Real>
Real Irradiance(const GradientSkyTerms<Real>& sky, const Imath::Vec3<Real>& normal) {
  const Real pi = static_cast<Real>(M_PI);
  const Real sin = std::hypot(normal.x, normal.z), cos = normal.y;
  const Real angle = std::atan2(sin, cos);
  const Real upper = 2 * (sin + (pi - angle) * cos) / 3;
  const Real lower = 2 * (sin - angle * cos) / 3;
  return pi * sky.horizon + (sky.zenith - sky.horizon) * upper + (sky.ground - sky.horizon) * lower;
}

// The radiance is a0 + a1 c + a2 c^2, where c is the cosine from an axis of unit length.
template <typename Real>
struct QuadraticSkyTerms {
  Imath::Vec3<Real> axis;
  Real a0, a1, a2;
};

template <typename Real>
Real Radiance(const QuadraticSkyTerms<Real>& sky, const Imath::Vec3<Real>& direction) {
  const Real c = sky.axis ^ direction;
  return sky.a0 + c * (sky.a1 + c * sky.a2);
}

// The integrals of 1, c and c^2 times the clamped cosine are pi, 2 pi / 3 c and pi / 4 (1 + c^2).
template <typename Real>
Real Irradiance(const QuadraticSkyTerms<Real>& sky, const Imath::Vec3<Real>& normal) {
  const Real c = sky.axis ^ normal;
  return static_cast<Real>(M_PI) * (sky.a0 + 2 * sky.a1 * c / 3 + sky.a2 * (1 + c * c) / 4);
}

}  // namespace nacre
