// SPDX-License-Identifier: Apache-2.0
// light/rectangle_light.h: sampling a rectangle as a light. SIMD twin: rectangle_light-inl.h.
//
// Samples are uniform in solid angle: Urena, Fajardo and King 2013, "An Area-Preserving
// Parametrization for Spherical Rectangles", rearranged so that nothing of the size of pi cancels:
// the sines and cosines of the corners' angles are algebraic in the coordinates, and the sum of the
// angles is never formed. Below kSmallSolidAngle samples are uniform in area.
#pragma once

#include <algorithm>
#include <cmath>

#include "light/area_sample.h"

namespace nacre {

// A corner and the two perpendicular edges from it. The front is on the side of edge_x cross
// edge_y.
template <typename Real>
struct RectangleLight {
  Imath::Vec3<Real> corner, edge_x, edge_y;
};

// The rectangle in the coordinate system of its axes, with the shaded point at the origin.
template <typename Real>
struct RectangleView {
  Imath::Vec3<Real> x_axis, y_axis, normal;
  Real width, height;
  Real x0, x1, y0, y1, z;
};

template <typename Real>
RectangleView<Real> ViewOf(const RectangleLight<Real>& light) {
  RectangleView<Real> view;
  view.width = light.edge_x.length();
  view.height = light.edge_y.length();
  view.x_axis = light.edge_x / view.width;
  view.y_axis = light.edge_y / view.height;
  view.normal = view.x_axis % view.y_axis;
  view.x0 = light.corner ^ view.x_axis;
  view.x1 = view.x0 + view.width;
  view.y0 = light.corner ^ view.y_axis;
  view.y1 = view.y0 + view.height;
  view.z = light.corner ^ view.normal;
  return view;
}

// The sum of the solid angles of two triangles (Van Oosterom and Strackee 1983), whose determinants
// are equal and contain no differences. 0 in the rectangle's plane.
template <typename Real>
Real SolidAngle(const RectangleView<Real>& view) {
  using Vec = Imath::Vec3<Real>;
  const Real determinant = std::abs(view.z) * view.width * view.height;
  if (!(determinant > 0)) return 0;
  const Vec p00(view.x0, view.y0, view.z), p10(view.x1, view.y0, view.z);
  const Vec p01(view.x0, view.y1, view.z), p11(view.x1, view.y1, view.z);
  const Real r00 = p00.length(), r11 = p11.length();
  const Real diagonal = r00 * r11 + (p00 ^ p11);
  const auto half = [&](const Vec& p) {
    const Real sum = p.length() * diagonal + (p ^ p00) * r11 + (p ^ p11) * r00;
    return std::atan2(determinant, sum);
  };
  return 2 * (half(p10) + half(p01));
}

template <typename Real>
Real SolidAngle(const RectangleLight<Real>& light) {
  return SolidAngle(ViewOf(light));
}

// The x for which the rectangle's part from x0 to x has the fraction `part` of its solid angle. The
// names are those of Urena et al., section 4; g2 and g3 are the angles at the corners of x0, and k
// = 2 pi - g2 - g3.
template <typename Real>
Real SampleRectangleX(const RectangleView<Real>& view, Real solid_angle, Real part) {
  const Real x0 = view.x0, y0 = view.y0, y1 = view.y1, z = std::abs(view.z);
  const Real across_x = std::hypot(x0, z), across_0 = std::hypot(y0, z),
             across_1 = std::hypot(y1, z);
  const Real r00 = std::hypot(across_x, y0), r01 = std::hypot(across_x, y1);
  const Real b0 = -y0 / across_0, b1 = y1 / across_1, n3z = -x0 / across_x;
  const Real sin_g2 = z * r01 / (across_1 * across_x), cos_g2 = -b1 * n3z;
  const Real sin_g3 = z * r00 / (across_0 * across_x), cos_g3 = -n3z * b0;
  // b0 sin_g2 + b1 sin_g3 = z / (...) (y1 r00 - y0 r01), whose terms cancel for a distant strip.
  const Real difference =
      y0 * y1 > 0 ? view.height * (y0 + y1) * across_x * across_x / (y1 * r00 + y0 * r01)
                  : y1 * r00 - y0 * r01;
  const Real q = z * difference / (across_x * across_0 * across_1);
  const Real sin_k = n3z * q;
  const Real cos_k = cos_g2 * cos_g3 - sin_g2 * sin_g3;
  // f_u = (b0 cos(a_u) - b1) / sin(a_u) at a_u = k + part solid_angle; at part = 0 it is -sin_g3 q
  // over sin k. The numerator is negative throughout.
  const Real sin_a = std::sin(part * solid_angle);
  const Real cos_a = std::cos(part * solid_angle);
  const Real sin_half = std::sin(part * solid_angle / 2);
  const Real numerator = -sin_g3 * q * cos_a - b1 * 2 * sin_half * sin_half - b0 * sin_k * sin_a;
  const Real denominator = sin_k * cos_a + cos_k * sin_a;
  const Real shorter = z / across_0 * denominator;
  const Real root2 = (-numerator - shorter) * (-numerator + shorter);
  const Real x = root2 > 0 ? -z * denominator / std::sqrt(root2) : x0;
  return std::clamp(x, x0, view.x1);
}

// Samples y on the segment at x, uniformly in h = y / distance, the sine of the angle to the plane
// y = 0.
template <typename Real>
Real SampleRectangleY(const RectangleView<Real>& view, Real x, Real part) {
  const Real across = std::hypot(x, view.z);
  const Real h0 = view.y0 / std::hypot(across, view.y0);
  const Real h1 = view.y1 / std::hypot(across, view.y1);
  const Real h = h0 + part * (h1 - h0);
  const Real y = h * across / std::sqrt(std::max((1 - h) * (1 + h), static_cast<Real>(0)));
  return std::clamp(y, view.y0, view.y1);
}

template <typename Real>
AreaSample<Real> SampleLight(const RectangleLight<Real>& light, Real u0, Real u1) {
  const RectangleView<Real> view = ViewOf(light);
  const Real solid_angle = SolidAngle(view);
  if (!(solid_angle > 0)) return {};
  const bool by_area = solid_angle < kSmallSolidAngle<Real>;
  const Real x = by_area ? view.x0 + u0 * view.width : SampleRectangleX(view, solid_angle, u0);
  const Real y = by_area ? view.y0 + u1 * view.height : SampleRectangleY(view, x, u1);
  const Real distance = std::hypot(std::hypot(x, y), view.z);
  if (!(distance > 0)) return {};
  AreaSample<Real> sample;
  sample.to_light = (view.x_axis * x + view.y_axis * y + view.normal * view.z) / distance;
  sample.distance = distance;
  sample.cos_light = -view.z / distance;
  const Real area = view.width * view.height;
  sample.inverse_pdf =
      by_area ? area * std::abs(sample.cos_light) / (distance * distance) : solid_angle;
  return sample;
}

template <typename Real>
Real LightPdf(const RectangleLight<Real>& light, const Imath::Vec3<Real>& direction) {
  const RectangleView<Real> view = ViewOf(light);
  const Real solid_angle = SolidAngle(view);
  const Real towards = direction ^ view.normal;
  if (!(solid_angle > 0) || !(view.z * towards > 0)) return 0;
  const Real t = view.z / towards;
  const Real x = t * (direction ^ view.x_axis), y = t * (direction ^ view.y_axis);
  if (!(x >= view.x0 && x <= view.x1 && y >= view.y0 && y <= view.y1)) return 0;
  if (solid_angle >= kSmallSolidAngle<Real>) return 1 / solid_angle;
  return t * t / (view.width * view.height * std::abs(towards));
}

}  // namespace nacre
