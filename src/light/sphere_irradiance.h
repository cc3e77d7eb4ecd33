// SPDX-License-Identifier: Apache-2.0
// light/sphere_irradiance.h: the irradiance of a surface under a sphere. SIMD twin:
// sphere_irradiance-inl.h.
//
// Snyder 1996, "Area Light Sources for Real-Time Graphics": with s the sine of the sphere's angular
// radius, t the angle from the normal to its centre and c = cos(t) / s its centre's height over the
// horizon in radii, the irradiance is pi s^2 cos(t) if the sphere is wholly above the horizon, else
//   s^2 cos(t) acos(-cot(t) cot(asin s)) - s k cos(asin s) + atan(k tan(asin s)),  k^2 = 1 - c^2.
// Its terms are of the order s and cancel to s^3, and next to c = -1 to (1 + c)^2.5 of that. The
// forms below are rearranged so that nothing cancels.
#pragma once

#include <cmath>

#include "base/trig.h"
#include "light/sphere_light.h"

namespace nacre {

// The irradiance of a sphere that the horizon clips: c in (-1, 1).
template <typename Real>
Real IrradianceOfClippedSphere(Real sin, Real c) {
  const Real cos = std::sqrt((1 - sin) * (1 + sin));
  const Real k = std::sqrt((1 - c) * (1 + c));
  if (cos < static_cast<Real>(0.5)) {  // too near for anything to cancel
    return sin * sin * sin * c * std::atan2(k, -c * cos) - k * sin * cos + std::atan2(k * sin, cos);
  }
  const Real tan = sin / cos;
  const Real from_horizon = AtanRemainder(k * tan);
  if (c > static_cast<Real>(-0.5)) {
    const Real k_cos = k / cos;
    return sin * sin * sin *
           (c * std::atan2(k, -c * cos) + k_cos * (1 - k_cos * k_cos * from_horizon));
  }
  // The first terms of both arc tangents cancel against the other terms, and are left out.
  const Real size = k * tan;
  return size * size * size * (AtanRemainder(-k / (c * cos)) / (c * c) - from_horizon);
}

template <typename Real>
Real Irradiance(const SphereLight<Real>& light, const Imath::Vec3<Real>& normal) {
  const Real pi = static_cast<Real>(M_PI);
  if (!(light.radius > 0)) return 0;
  if (IsInside(light)) return pi;
  const Real c = (normal ^ light.centre) / light.radius;
  if (c <= -1) return 0;
  const Real sin = ConeOf(light).sin;
  if (c >= 1) return pi * sin * sin * sin * c;
  return IrradianceOfClippedSphere(sin, c);
}

}  // namespace nacre
