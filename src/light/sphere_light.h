// SPDX-License-Identifier: Apache-2.0
// light/sphere_light.h: a sphere as a light: sampling and irradiance. SIMD twin:
// sphere_light-inl.h.
//
// From outside, directions are uniform in the cone that the sphere subtends. From inside of a
// sphere that emits on both sides they are uniform over all directions, and cos_light is negative.
// On the surface the cone is the half-space towards the centre.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/basis.h"
#include "base/trig.h"
#include "light/area_sample.h"

namespace nacre {

template <typename Real>
struct SphereLight {
  Imath::Vec3<Real> centre;
  Real radius;
};

// The cone of directions from a point outside.
template <typename Real>
struct SphereCone {
  Real distance;       // from the point to the centre
  Real sin;            // sine of the half angle: radius / distance, 1 from inside
  Real one_minus_cos;  // sin^2 / (1 + cos): the difference would cancel for far spheres
};

template <typename Real>
SphereCone<Real> ConeOf(const SphereLight<Real>& light) {
  const Real distance = light.centre.length();
  if (!(distance > light.radius)) return {distance, 1, 1};
  const Real sin = light.radius / distance;
  return {distance, sin, sin * sin / (1 + std::sqrt((1 - sin) * (1 + sin)))};
}

template <typename Real>
bool IsInside(const SphereLight<Real>& light) {
  return light.centre.length() < light.radius;
}

template <typename Real>
Real SolidAngle(const SphereLight<Real>& light) {
  const Real two_pi = 2 * static_cast<Real>(M_PI);
  return IsInside(light) ? 2 * two_pi : two_pi * ConeOf(light).one_minus_cos;
}

template <typename Real>
AreaSample<Real> SampleSphereFromInside(const SphereLight<Real>& light, Real u0, Real u1) {
  const Real z = 1 - 2 * u0;
  const Real r = 2 * std::sqrt(u0 * (1 - u0));
  const Real phi = 2 * static_cast<Real>(M_PI) * u1;
  AreaSample<Real> sample;
  sample.to_light = {r * std::cos(phi), r * std::sin(phi), z};
  const Real along = light.centre ^ sample.to_light;
  const Real distance = light.centre.length();
  const Real power = (light.radius - distance) * (light.radius + distance);
  const Real root = std::sqrt(along * along + power);
  // The larger root of t^2 - 2 along t - power = 0, in the form that does not cancel.
  sample.distance = along >= 0 ? along + root : power / (root - along);
  sample.inverse_pdf = 4 * static_cast<Real>(M_PI);
  sample.cos_light = -root / light.radius;
  return sample;
}

template <typename Real>
AreaSample<Real> SampleLight(const SphereLight<Real>& light, Real u0, Real u1) {
  if (!(light.radius > 0)) return {};
  if (IsInside(light)) return SampleSphereFromInside(light, u0, u1);
  const SphereCone<Real> cone = ConeOf(light);
  const Real m = cone.one_minus_cos;
  const Real x = u0 * m;  // 1 - cos of the sample's angle from the axis
  AreaSample<Real> sample;
  sample.to_light = DirectionAround(light.centre / cone.distance, x, u1);
  // Half the chord in units of the centre's distance: sin^2 of the cone minus that of the sample.
  const Real half_chord = std::sqrt(m * (1 - u0) * (2 - m * (1 + u0)));
  // The product of both intersections' distances, distance^2 - radius^2, over the farther one.
  sample.distance = cone.distance * (1 - cone.sin) * (1 + cone.sin) / (1 - x + half_chord);
  sample.inverse_pdf = 2 * static_cast<Real>(M_PI) * m;
  sample.cos_light = std::min(half_chord / cone.sin, static_cast<Real>(1));
  return sample;
}

// Directions to the rim itself may count as misses, by rounding.
template <typename Real>
Real LightPdf(const SphereLight<Real>& light, const Imath::Vec3<Real>& direction) {
  const Real solid_angle = SolidAngle(light);
  if (!(solid_angle > 0)) return 0;
  if (IsInside(light)) return 1 / solid_angle;
  const bool hit = (direction ^ light.centre) > 0 &&
                   (direction % light.centre).length2() <= light.radius * light.radius;
  return hit ? 1 / solid_angle : 0;
}

// The irradiance of a surface under the sphere. Snyder 1996, "Area Light Sources for Real-Time
// Graphics": with s the sine of the sphere's angular radius, t the angle from the normal to its
// centre and c = cos(t) / s its centre's height over the horizon in radii, it is pi s^2 cos(t) if
// the sphere is wholly above the horizon, else
//   s^2 cos(t) acos(-cot(t) cot(asin s)) - s k cos(asin s) + atan(k tan(asin s)),  k^2 = 1 - c^2.
// Its terms are of the order s and cancel to s^3, and next to c = -1 to (1 + c)^2.5 of that. The
// forms below are rearranged so that nothing cancels.

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
