// SPDX-License-Identifier: Apache-2.0
// light/ellipse_irradiance.h: the irradiance of a surface under an ellipse: what disks, and
// spheres, become under the matrices of ltc.h. SIMD twin: ellipse_irradiance-inl.h.
//
// Heitz and Hill 2017, "Real-Time Line- and Disk-Light Shading with Linearly Transformed Cosines":
// the rays through an ellipse are a cone that an eigenproblem gives perpendicular axes, half as
// wide as a and b at distance 1. By symmetry all of its light flows along its axis: an irradiance
// of pi a b / sqrt((1 + a^2) (1 + b^2)) for a surface that faces that way, times the cosine for
// others that see all of it. Where the horizon cuts it they take a table of spheres that flow as
// strongly; here is the contour integral of disk_irradiance.h, which on these axes is elementary,
// too: along the rim (a cos t, b sin t, 1), distance^2 = (1 + a^2) cos^2 t + (1 + b^2) sin^2 t.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/basis.h"
#include "light/disk_irradiance.h"
#include "light/sphere_light.h"

namespace nacre {

// Relative to the shaded point: the rim is centre + x cos(t) + y sin(t), which a matrix leaves
// that.
struct EllipseLight {
  Vec3d centre, x, y;
};

inline EllipseLight EllipseOf(const DiskLight<double>& disk) {
  const Basis<double> basis = BasisAbout(disk.normal);
  return {disk.centre, basis.x * disk.radius, basis.y * disk.radius};
}

// The circle where the sphere ends for a point outside.
inline EllipseLight EllipseOf(const SphereLight<double>& sphere) {
  const double distance = sphere.centre.length();
  const Basis<double> basis = BasisAbout(sphere.centre / distance);
  const double sin = sphere.radius / distance;
  const double cos2 = (1 - sin) * (1 + sin), radius = sphere.radius * std::sqrt(cos2);
  return {sphere.centre * cos2, basis.x * radius, basis.y * radius};
}

// The cone of S = x x^T + y y^T - centre centre^T, whose eigenvalues are flat a^2, flat b^2 and
// -flat.
struct EllipseCone {
  Vec3d axis;
  double determinant;  // of centre, x and y: not negative
  double flat;
  double widths;  // flat^2 (1 + a^2) (1 + b^2)
};

// The one positive root of y^3 + trace y^2 + minors y - determinant^2, from somewhere above it.
// Laguerre's method never passes it, and has it in few steps: its error is cubed in each. Six leave
// that of a point within a thousandth of a wide ellipse open, eight none.
inline constexpr int kRootSteps = 8;
// The next step would be its cube.
inline constexpr double kRootRounding = 1e-6;

inline double LargestRoot(double trace, double minors, double determinant2, double y) {
  for (int i = 0; i < kRootSteps; ++i) {
    const double p = ((y + trace) * y + minors) * y - determinant2;
    const double slope = (3 * y + 2 * trace) * y + minors;
    const double root = 4 * slope * slope - 12 * p * (3 * y + trace);
    if (!(p > 0)) break;
    const double step = 3 * p / (slope + std::sqrt(std::max(root, 0.0)));
    y -= step;
    if (step < kRootRounding * y) break;
  }
  return y;
}

// The eigenvector is a column of S's adjugate once -flat is taken off its diagonal: all columns are
// multiples of it, of which those along the centre and along the ellipse's normal do not cancel.
inline EllipseCone ConeOf(const EllipseLight& light) {
  const Vec3d &c = light.centre, &x = light.x, &y = light.y;
  Vec3d across = x % y;
  const Vec3d yc = y % c, cx = c % x;
  EllipseCone cone;
  cone.determinant = across ^ c;
  if (cone.determinant < 0) {
    across = -across;
    cone.determinant = -cone.determinant;
  }
  const double c2 = c.length2(), trace = x.length2() + y.length2() - c2;
  const double minors = across.length2() - yc.length2() - cx.length2();
  const double flat = LargestRoot(trace, minors, cone.determinant * cone.determinant, c2);
  cone.flat = flat;
  cone.widths = (3 * flat + 2 * trace) * flat + minors;
  const Vec3d seed = c * across.length() + across * c.length();
  const Vec3d s_seed = x * (x ^ seed) + y * (y ^ seed) - c * (c ^ seed);
  const Vec3d column = across * (across ^ seed) - yc * (yc ^ seed) - cx * (cx ^ seed) +
                       (seed * (trace + flat) - s_seed) * flat;
  cone.axis = column.normalized();
  return cone;
}

// All above the horizon.
inline double IrradianceOfWholeEllipse(const EllipseCone& cone, const Vec3d& normal) {
  return M_PI * cone.determinant / std::sqrt(cone.flat * cone.widths) * (cone.axis ^ normal);
}

// A cone on its own axes, z along it.
struct EllipseAxes {
  double a, b;   // a >= b
  Vec3d normal;  // the surface's
};

// The two other eigenvectors are in the plane across the axis: a rotation away from any two.
inline EllipseAxes AxesOf(const EllipseLight& light, const EllipseCone& cone, const Vec3d& normal) {
  const Basis<double> basis = BasisAbout(cone.axis);
  const Vec3d x = basis.ToLocal(light.x), y = basis.ToLocal(light.y),
              c = basis.ToLocal(light.centre);
  const double xx = x.x * x.x + y.x * y.x - c.x * c.x, xy = x.x * x.y + y.x * y.y - c.x * c.y,
               yy = x.y * x.y + y.y * y.y - c.y * c.y;
  const double larger = (xx + yy) / 2 + std::hypot((xx - yy) / 2, xy);
  const double turn = std::atan2(2 * xy, xx - yy) / 2;
  const double cos = std::cos(turn), sin = std::sin(turn);
  const Vec3d n = basis.ToLocal(normal);
  const double a = std::sqrt(larger / cone.flat);
  return {a,
          cone.determinant / (cone.flat * std::sqrt(cone.flat) * a),
          {n.x * cos + n.y * sin, n.y * cos - n.x * sin, n.z}};
}

// A point of the rim, and the antiderivatives there of 1, cos(t) and sin(t) over distance^2.
struct EllipseRimPoint {
  Vec3d position;
  double one, cos, sin;
};

inline EllipseRimPoint RimPointAt(const EllipseAxes& axes, double t) {
  const double a = axes.a, b = axes.b, c = std::cos(t), s = std::sin(t);
  const double size_a = std::sqrt(1 + a * a), size_b = std::sqrt(1 + b * b);
  const double excess2 = (a - b) * (a + b), excess = std::sqrt(std::max(excess2, 0.0));
  const double distance = std::sqrt(1 + a * a * c * c + b * b * s * s);
  EllipseRimPoint rim;
  rim.position = {a * c, b * s, 1};
  // The arc tangent of tan(t) size_b / size_a, over any number of turns.
  const double slower = excess2 / (size_a + size_b) * s * c;
  rim.one = (t - std::atan2(slower, size_a * c * c + size_b * s * s)) / (size_a * size_b);
  // A hyperbolic arc tangent and an arc tangent over the excess, which have limits for circles.
  const bool round = !(excess > 0);
  rim.cos = (round ? s / distance : std::asinh(excess * s / distance) / excess) / size_a;
  rim.sin = -(round ? c / size_b : std::atan(excess * c / size_b) / excess) / size_b;
  return rim;
}

// The ellipse cut by the horizon. Terms of the order of its angular size cancel to its cube: below
// 1e-5 it is a speck, and its height's first moment.
inline double IrradianceOfRisingEllipse(const EllipseAxes& axes) {
  const Vec3d& n = axes.normal;
  const double along_a = axes.a * n.x, along_b = axes.b * n.y;
  const double rim_height = std::sqrt(along_a * along_a + along_b * along_b);
  const double horizon = std::clamp(-n.z / rim_height, -1.0, 1.0);
  if (axes.a < 1e-5) return axes.a * axes.b * rim_height * HeightMoment(horizon);
  const double highest = std::atan2(along_b, along_a), half = std::acos(horizon);
  const EllipseRimPoint from = RimPointAt(axes, highest - half);
  const EllipseRimPoint to = RimPointAt(axes, highest + half);
  const double arc = axes.a * axes.b * n.z * (to.one - from.one) -
                     axes.b * n.x * (to.cos - from.cos) - axes.a * n.y * (to.sin - from.sin);
  const double chord = std::atan2(n ^ (to.position % from.position), to.position ^ from.position);
  return std::clamp((arc + chord) / 2, 0.0, M_PI);
}

// Of the highest point of the rim over the centre.
inline double RimHeight(const EllipseLight& light, const Vec3d& normal) {
  const double x = light.x ^ normal, y = light.y ^ normal;
  return std::sqrt(x * x + y * y);
}

// Whether the horizon cuts it.
inline bool IsCut(const EllipseLight& light, const Vec3d& normal) {
  return std::abs(light.centre ^ normal) < RimHeight(light, normal);
}

inline double Irradiance(const EllipseLight& light, const Vec3d& normal) {
  const double height = light.centre ^ normal;
  if (height <= -RimHeight(light, normal)) return 0;
  const EllipseCone cone = ConeOf(light);
  if (!(cone.determinant > 0)) return 0;
  if (!IsCut(light, normal)) return IrradianceOfWholeEllipse(cone, normal);
  return IrradianceOfRisingEllipse(AxesOf(light, cone, normal));
}

}  // namespace nacre
