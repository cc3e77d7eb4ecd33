// SPDX-License-Identifier: Apache-2.0
// light/triangle_light.h: sampling a triangle as a light. SIMD twin: triangle_light-inl.h.
//
// Samples are uniform in solid angle, by Arvo's map (1995, "Stratified Sampling of Spherical
// Triangles"), derived from the tangent formula of Van Oosterom and Strackee 1983 instead of the
// corners' angles, and with differences of unit vectors computed from the edges: nothing cancels,
// even for tiny triangles. Below kSmallSolidAngle samples are uniform in area.
#pragma once

#include <cmath>

#include "light/area_sample.h"

namespace nacre {

// The vertices are corner, corner + edge_x and corner + edge_y. The front is on the side of edge_x
// cross edge_y.
template <typename Real>
struct TriangleLight {
  Imath::Vec3<Real> corner, edge_x, edge_y;
};

// (p + e) / |p + e| - p / |p|, without cancellation.
template <typename Real>
Imath::Vec3<Real> UnitDifference(const Imath::Vec3<Real>& p, const Imath::Vec3<Real>& e) {
  const Imath::Vec3<Real> q = p + e;
  const Real p_length = p.length(), q_length = q.length();
  const Real longer = (e ^ (p + q)) / (p_length + q_length);
  return (e - p * (longer / p_length)) / q_length;
}

// The triangle projected to the unit sphere: vertex a, and the differences b - a and c - a.
template <typename Real>
struct SphericalTriangle {
  Imath::Vec3<Real> a, to_b, to_c;
  Real determinant;  // |a.(b x c)|
  Real one_plus_ab;
  Real solid_angle;  // 0 in the triangle's plane
};

template <typename Real>
SphericalTriangle<Real> SphericalTriangleOf(const TriangleLight<Real>& light) {
  SphericalTriangle<Real> t;
  t.a = light.corner.normalized();
  t.to_b = UnitDifference(light.corner, light.edge_x);
  t.to_c = UnitDifference(light.corner, light.edge_y);
  t.determinant = std::abs(t.a ^ (t.to_b % t.to_c));
  // 1 + a.b = 2 - |a - b|^2 / 2, and correspondingly for the other pairs.
  t.one_plus_ab = 2 - t.to_b.length2() / 2;
  const Real sum = t.one_plus_ab + 2 - t.to_c.length2() / 2 - (t.to_c - t.to_b).length2() / 2;
  t.solid_angle = t.determinant > 0 ? 2 * std::atan2(t.determinant, sum) : 0;
  return t;
}

template <typename Real>
Real SolidAngle(const TriangleLight<Real>& light) {
  return SphericalTriangleOf(light).solid_angle;
}

// Samples a direction uniformly in the spherical triangle.
template <typename Real>
Imath::Vec3<Real> SampleSphericalTriangle(const SphericalTriangle<Real>& t, Real u0, Real u1) {
  using Vec = Imath::Vec3<Real>;
  // c' is the point on the arc from a to c for which (a, b, c') has the solid angle u0 solid_angle:
  // with tau the tangent of half the arc from a to c', tan(solid angle / 2) =
  // tau det(a, b, tangent) / (1 + a.b + tau b.tangent), solved for tau = numerator / denominator.
  const Vec tangent = (t.to_c + t.a * (t.to_c.length2() / 2)).normalized();
  const Real half_area = u0 * t.solid_angle / 2;
  const Real sin = std::sin(half_area);
  const Real numerator = sin * t.one_plus_ab;
  const Real denominator =
      std::cos(half_area) * std::abs(t.a ^ (t.to_b % tangent)) - sin * (t.to_b ^ tangent);
  const Real size2 = numerator * numerator + denominator * denominator;
  const Vec to_c = (tangent * denominator - t.a * numerator) * (2 * numerator / size2);
  // The sample lies on the arc from b to c', uniform in 1 - cos.
  const Vec b = t.a + t.to_b;
  const Vec chord = to_c - t.to_b;
  const Real x = u1 * chord.length2() / 2;
  const Vec across = chord + b * (chord.length2() / 2);
  const Real across_length = across.length();
  if (!(across_length > 0)) return b;  // c' = b: the arc has no length
  return (b * (1 - x) + across * (std::sqrt(x * (2 - x)) / across_length)).normalized();
}

template <typename Real>
AreaSample<Real> SampleLight(const TriangleLight<Real>& light, Real u0, Real u1) {
  const SphericalTriangle<Real> t = SphericalTriangleOf(light);
  if (!(t.solid_angle > 0)) return {};
  const Imath::Vec3<Real> cross = light.edge_x % light.edge_y;
  const Real twice_area = cross.length();
  AreaSample<Real> sample;
  if (t.solid_angle < kSmallSolidAngle<Real>) {
    const Real root = std::sqrt(u0);
    const Imath::Vec3<Real> to_light =
        light.corner + light.edge_x * (root * (1 - u1)) + light.edge_y * (root * u1);
    sample.distance = to_light.length();
    sample.to_light = to_light / sample.distance;
    sample.cos_light = -(sample.to_light ^ cross) / twice_area;
    sample.inverse_pdf =
        twice_area / 2 * std::abs(sample.cos_light) / (sample.distance * sample.distance);
    return sample;
  }
  sample.to_light = SampleSphericalTriangle(t, u0, u1);
  const Real towards = sample.to_light ^ cross;
  sample.distance = (light.corner ^ cross) / towards;
  if (!(sample.distance > 0) || towards == 0) return {};  // edge-on up to rounding
  sample.cos_light = -towards / twice_area;
  sample.inverse_pdf = t.solid_angle;
  return sample;
}

template <typename Real>
Real LightPdf(const TriangleLight<Real>& light, const Imath::Vec3<Real>& direction) {
  const Real solid_angle = SolidAngle(light);
  const Imath::Vec3<Real> cross = light.edge_x % light.edge_y;
  const Real towards = direction ^ cross;
  const Real t = (light.corner ^ cross) / towards;
  if (!(solid_angle > 0) || !(t > 0)) return 0;
  // t direction = corner + x edge_x + y edge_y (Cramer).
  const Real x = (light.corner ^ (direction % light.edge_y)) / towards;
  const Real y = -(light.corner ^ (direction % light.edge_x)) / towards;
  if (!(x >= 0 && y >= 0 && x + y <= 1)) return 0;
  if (solid_angle >= kSmallSolidAngle<Real>) return 1 / solid_angle;
  return 2 * t * t / std::abs(towards);
}

}  // namespace nacre
