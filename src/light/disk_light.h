// SPDX-License-Identifier: Apache-2.0
// light/disk_light.h: a disk as a light: sampling and irradiance. SIMD twin: disk_light-inl.h.
//
// The solid angle of a disk is an elliptic integral, and a map that is uniform in solid angle needs
// its inverse (Guillen et al. 2017). Instead, a disk at some distance is sampled by area, which is
// nearly uniform because cosine and distance vary little over it. A nearby disk, where they vary
// without bound, is sampled uniformly in solid angle over the square around it, and samples that
// miss the disk, about a fifth, are discarded. At the transition both have about the same variance.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/basis.h"
#include "base/trig.h"
#include "light/rectangle_light.h"

namespace nacre {

template <typename Real>
struct DiskLight {
  Imath::Vec3<Real> centre;
  Imath::Vec3<Real> normal;  // unit length, out of the front
  Real radius;
};

// The disk's axes, with x pointing away from the shaded point, and the coordinates of its centre in
// them: z normal + rho x_axis.
template <typename Real>
struct DiskView {
  Imath::Vec3<Real> x_axis, y_axis;
  Real rho, z;
};

// The centre is first transformed to an arbitrary basis about the normal: next to the disk's axis,
// centre - z normal would be pure rounding error.
template <typename Real>
DiskView<Real> ViewOf(const DiskLight<Real>& light) {
  const Basis<Real> basis = BasisAbout(light.normal);
  const Imath::Vec3<Real> centre = basis.ToLocal(light.centre);
  const Real rho = std::hypot(centre.x, centre.y);
  const Real cos = rho > 0 ? centre.x / rho : 1;
  const Real sin = rho > 0 ? centre.y / rho : 0;
  return {basis.x * cos + basis.y * sin, basis.y * cos - basis.x * sin, rho, centre.z};
}

// Whether the disk's nearest point is nearer than 0.7 radii. At that distance, on the disk's axis,
// losing a fifth of the samples costs as much variance as sampling by area does.
template <typename Real>
bool IsNearby(const DiskView<Real>& view, Real radius) {
  const Real beside = std::max(view.rho - radius, static_cast<Real>(0));
  return beside * beside + view.z * view.z < static_cast<Real>(0.49) * radius * radius;
}

template <typename Real>
RectangleLight<Real> SquareAround(const DiskLight<Real>& light, const DiskView<Real>& view) {
  const Imath::Vec3<Real> x = view.x_axis * light.radius, y = view.y_axis * light.radius;
  return {light.centre - x - y, x * 2, y * 2};
}

// The solid angle, in double, for choosing among lights; sampling does not need it. It is the
// contour integral of e.(r x dr) / (r (r + e.r)), where e is the direction to the centre, which is
// radius^2 e.normal dt / (r (r + e.r)): nothing cancels. The trapezoidal rule over a period
// converges exponentially, but more slowly the nearer the disk is: the error is 1e-10 down to
// heights of 1/5000 of the radius.
inline double SolidAngle(const DiskLight<double>& light) {
  const DiskView<double> view = ViewOf(light);
  const double distance = std::hypot(view.rho, view.z);
  if (view.z == 0 || !(light.radius > 0)) return 0;
  const double beside = view.rho - light.radius;
  const double nearness = light.radius / std::hypot(std::max(beside, 0.0), view.z);
  const int steps = 16 + static_cast<int>(24 * std::min(nearness, 5000.0));
  double sum = 0;
  for (int i = 0; i < steps; ++i) {  // half of the period: the other half is symmetric
    const double cos = std::cos(M_PI * (i + 0.5) / steps);
    const double along = light.radius * view.rho * cos / distance;
    const double r =
        std::hypot(view.rho + light.radius * cos,
                   std::hypot(view.z, light.radius * std::sqrt((1 - cos) * (1 + cos))));
    sum += 1 / (r * (r + distance + along));
  }
  return 2 * M_PI / steps * sum * light.radius * light.radius * std::abs(view.z) / distance;
}

template <typename Real>
AreaSample<Real> SampleLight(const DiskLight<Real>& light, Real u0, Real u1) {
  const DiskView<Real> view = ViewOf(light);
  if (view.z == 0 || !(light.radius > 0)) return {};
  if (IsNearby(view, light.radius)) {
    AreaSample<Real> sample = SampleLight(SquareAround(light, view), u0, u1);
    const Imath::Vec3<Real> point = sample.to_light * sample.distance - light.centre;
    if (point.length2() > light.radius * light.radius) sample.inverse_pdf = 0;
    return sample;
  }
  const PointOnDisk<Real> on_disk = ConcentricDisk(u0, u1);
  const Imath::Vec3<Real> to_light =
      light.centre + (view.x_axis * on_disk.x + view.y_axis * on_disk.y) * light.radius;
  AreaSample<Real> sample;
  sample.distance = to_light.length();
  sample.to_light = to_light / sample.distance;
  sample.cos_light = -view.z / sample.distance;
  sample.inverse_pdf = static_cast<Real>(M_PI) * light.radius * light.radius *
                       std::abs(sample.cos_light) / (sample.distance * sample.distance);
  return sample;
}

// The pdf integrates to 1, or for a nearby disk to the fraction of samples that are not discarded.
template <typename Real>
Real LightPdf(const DiskLight<Real>& light, const Imath::Vec3<Real>& direction) {
  const DiskView<Real> view = ViewOf(light);
  const Real towards = direction ^ light.normal;
  if (!(view.z * towards > 0)) return 0;
  const Real t = view.z / towards;
  const Real radius2 = light.radius * light.radius;
  if ((direction * t - light.centre).length2() > radius2) return 0;
  if (IsNearby(view, light.radius)) return LightPdf(SquareAround(light, view), direction);
  return t * t / (static_cast<Real>(M_PI) * radius2 * std::abs(towards));
}

// The irradiance of a surface under the disk. By Stokes' theorem it is half the contour integral of
// normal.(r x dr) / r^2 (Fock 1924, Lambert for polygons). On a circle r^2 = a + b cos(t), so the
// integral is elementary, also over the arc above the horizon; the chord along the horizon
// contributes its angle. The surface's normal has the components n in the axes of DiskView.
template <typename Real>
struct DiskHorizonTerms {
  Imath::Vec3<Real> n;
  Real rho, z, radius;
  Real centre_height;  // height of the centre over the horizon
  Real rim_height;     // height of the rim's highest point over the centre
};

template <typename Real>
DiskHorizonTerms<Real> MakeDiskHorizonTerms(const DiskLight<Real>& light,
                                            const Imath::Vec3<Real>& normal) {
  const DiskView<Real> view = ViewOf(light);
  const Imath::Vec3<Real> n(normal ^ view.x_axis, normal ^ view.y_axis, normal ^ light.normal);
  return {n,
          view.rho,
          view.z,
          light.radius,
          normal ^ light.centre,
          light.radius * std::hypot(n.x, n.y)};
}

// The irradiance of a disk above the horizon is pi radius^2 (n.z (w + q) + 2 z rho n.x) /
// (q (a + q)) with a = z^2 + rho^2 + radius^2, w = z^2 + radius^2 - rho^2,
// q^2 = a^2 - b^2 = w^2 + (2 z rho)^2.
template <typename Real>
Real IrradianceOfWholeDisk(const DiskHorizonTerms<Real>& disk) {
  const Real radius2 = disk.radius * disk.radius, z2 = disk.z * disk.z;
  const Real a = z2 + disk.rho * disk.rho + radius2;
  const Real w = z2 + (disk.radius - disk.rho) * (disk.radius + disk.rho);
  const Real cross = 2 * disk.z * disk.rho;
  const Real q = std::hypot(w, cross);
  const Real w_plus_q = w > 0 ? w + q : cross * cross / (q - w);
  return static_cast<Real>(M_PI) * radius2 * std::abs(disk.n.z * w_plus_q + cross * disk.n.x) /
         (q * (a + q));
}

// The integral of max(y - x, 0) over the unit disk, where y is a coordinate on it.
template <typename Real>
Real HeightMoment(Real x) {
  const Real y = std::sqrt((1 - x) * (1 + x));
  return 2 * y * y * y / 3 - x * (std::acos(x) - x * y);
}

// The irradiance of a disk that the horizon clips, and that is so small (below 1e-5 of its
// distance) that distance and direction are constant over it: it is proportional to the first
// moment of height over the segment above the horizon. The relative error is 4 times the ratio of
// size and distance.
template <typename Real>
Real IrradianceOfSmallClippedDisk(const DiskHorizonTerms<Real>& disk) {
  const Real x = -disk.centre_height / disk.rim_height;  // the horizon, in radii from the centre
  const Real distance2 = disk.z * disk.z + disk.rho * disk.rho;
  return std::abs(disk.z) * disk.radius * disk.radius * disk.rim_height * HeightMoment(x) /
         (distance2 * distance2);
}

// A point of the rim, and the antiderivatives there of 1, cos(t) and sin(t) over a + b cos(t).
template <typename Real>
struct RimPoint {
  Imath::Vec3<Real> position;
  Real distance2;  // a + b cos(t)
  Real one, cos;   // for sin(t), the difference is a logarithm of the ratio of distance2
};

template <typename Real>
RimPoint<Real> RimPointAt(const DiskHorizonTerms<Real>& disk, Real t) {
  const Real radius2 = disk.radius * disk.radius, z2 = disk.z * disk.z;
  const Real a = z2 + disk.rho * disk.rho + radius2;
  const Real b = 2 * disk.rho * disk.radius;
  const Real w = z2 + (disk.radius - disk.rho) * (disk.radius + disk.rho);
  const Real q = std::hypot(w, 2 * disk.z * disk.rho);
  RimPoint<Real> rim;
  rim.position = {disk.rho + disk.radius * std::cos(t), disk.radius * std::sin(t), disk.z};
  // a - b + b (1 + cos(t)), which does not cancel where the rim passes by the point.
  const Real cos_half = std::cos(t / 2);
  rim.distance2 =
      z2 + (disk.radius - disk.rho) * (disk.radius - disk.rho) + 2 * b * cos_half * cos_half;
  // The arc tangent divided by b, which has a limit at b = 0.
  const Real slope = std::sin(t) / (q + rim.distance2);
  const Real x = std::abs(b * slope);
  const Real angle_over_b = slope * (1 - x * x * AtanRemainder(x));
  rim.one = (t - 2 * b * angle_over_b) / q;
  rim.cos = (2 * a * angle_over_b - t * b / (a + q)) / q;
  return rim;
}

// The irradiance of a disk that the horizon clips. In double only: terms of the order of the disk's
// angular size cancel to its cube, so that 6 digits are left where it is 1e-5.
inline double IrradianceOfClippedDisk(const DiskHorizonTerms<double>& disk) {
  const double distance = std::hypot(disk.z, disk.rho);
  if (disk.radius < 1e-5 * distance) return IrradianceOfSmallClippedDisk(disk);
  const double highest = std::atan2(disk.n.y, disk.n.x);
  const double half = std::acos(std::fmax(-1, std::fmin(1, -disk.centre_height / disk.rim_height)));
  const RimPoint<double> from = RimPointAt(disk, highest - half);
  const RimPoint<double> to = RimPointAt(disk, highest + half);
  const double sin_integral =
      -std::log1p((to.distance2 - from.distance2) / from.distance2) / (2 * disk.rho * disk.radius);
  const double sin_limit = (from.position.x - to.position.x) / (disk.radius * from.distance2);
  const double arc = disk.radius * disk.n.z * (to.one - from.one) +
                     (disk.rho * disk.n.z - disk.z * disk.n.x) * (to.cos - from.cos) -
                     disk.z * disk.n.y * (disk.rho > 1e-9 * distance ? sin_integral : sin_limit);
  const double chord =
      std::atan2(disk.n ^ (to.position % from.position), to.position ^ from.position);
  return std::min(std::abs(disk.radius * arc + chord) / 2, M_PI);
}

template <typename Real>
Real Irradiance(const DiskLight<Real>& light, const Imath::Vec3<Real>& normal) {
  const DiskHorizonTerms<Real> disk = MakeDiskHorizonTerms(light, normal);
  if (disk.z == 0 || !(disk.radius > 0) || disk.centre_height <= -disk.rim_height) return 0;
  if (disk.centre_height >= disk.rim_height) return IrradianceOfWholeDisk(disk);
  return static_cast<Real>(IrradianceOfClippedDisk(
      {Vec3d(disk.n), disk.rho, disk.z, disk.radius, disk.centre_height, disk.rim_height}));
}

}  // namespace nacre
