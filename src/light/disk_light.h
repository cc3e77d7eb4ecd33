// SPDX-License-Identifier: Apache-2.0
// light/disk_light.h: sampling a disk as a light. SIMD twin: disk_light-inl.h.
//
// The solid angle of a disk is an elliptic integral, and a map that is uniform in solid angle needs
// its inverse (Guillen et al. 2017). Instead, a disk at some distance is sampled by area, which is
// nearly uniform because cosine and distance vary little over it. A nearby disk, where they vary
// without bound, is sampled uniformly in solid angle over the square around it, and samples that
// miss the disk, about a fifth, are discarded. At the transition both have about the same variance.
#pragma once

#include <cmath>

#include "base/basis.h"
#include "base/concentric_disk.h"
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
  DiskView<Real> view;
  view.z = centre.z;
  view.rho = std::hypot(centre.x, centre.y);
  const Real cos = view.rho > 0 ? centre.x / view.rho : 1;
  const Real sin = view.rho > 0 ? centre.y / view.rho : 0;
  view.x_axis = basis.x * cos + basis.y * sin;
  view.y_axis = basis.y * cos - basis.x * sin;
  return view;
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

}  // namespace nacre
