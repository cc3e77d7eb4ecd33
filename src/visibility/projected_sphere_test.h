// SPDX-License-Identifier: Apache-2.0
// visibility/projected_sphere_test.h: the ray-sphere test of most camera rays, which compares film
// positions: fewer operations than the test of sphere_test.h, and no more rounding. SIMD twin:
// projected_sphere_test-inl.h, the same operations in the same order.
//
// The directions of a perspective camera's rays end on the film plane, direction . forward = 1. The
// point where the line to a sphere's centre crosses the plane, projected_center, is computed once
// for all rays. Then
//   offset = (direction - projected_center) depth / radius
// leads from the sphere's centre to the ray's point at the centre's depth, in radii. Its component
// along the ray gives the point where the ray is nearest to the centre, the rest the distance
// there:
//   discriminant = |direction|^2 (1 - |offset|^2) + (offset . direction)^2,
// which is that of sphere_test.h over radius^2. There products as large as the sphere's distance
// cancel, and their rounding is compensated; here the difference of two film positions comes first,
// and loses no digit of either. That takes fewer operations, and far fewer without fused
// multiply-adds.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vec.h"
#include "hit/camera_frame.h"
#include "visibility/geometry.h"
#include "visibility/sphere_test.h"

namespace nacre {

// Projecting a smaller sphere does not pay: there would be about one sphere for each ray.
inline constexpr double kMinProjectedRadius = 8;  // in pixels

// The largest distance of a sphere, in radii. A projected centre that is rounded to half a double's
// digits is off by 2^-26 of the distance, which up to here is a small part of the radius.
inline constexpr double kMaxProjectedScale = 0x1p22;

// The offset of a ray at an angle to `forward` may be as long as 1 / cos(angle), and its square
// cancels in the discriminant: up to 45 degrees that is 2, no worse than in sphere_test.h. Wider
// views therefore do not use this test.
inline ProjectedTestView MakeProjectedTestView(const CameraFrame& frame) {
  if (frame.projection != Projection::kPerspective || frame.corner.length2() > 2) return {};
  return {frame.forward,
          std::min(1 / (kMinProjectedRadius * frame.step_x.length()), kMaxProjectedScale)};
}

// All perspective rays go to one side of the plane through the eye perpendicular to `forward`. A
// sphere that lies on that side, by a margin far above the test's error, is hit by a ray wherever
// the ray's line meets it.
inline bool IsInFront(const TraceSphere& sphere, const Vec3d& forward) {
  const Vec3d& center = sphere.center;
  const double sum = std::abs(center.x) + std::abs(center.y) + std::abs(center.z) + sphere.radius;
  return center.dot(forward) - sphere.radius > 1e-9 * sum;
}

// Whether rays of the view are tested against the sphere by this test: never for the default view,
// whose `forward` is 0.
inline bool UsesProjectedTest(const TraceSphere& sphere, const ProjectedTestView& view) {
  return sphere.center.dot(view.forward) <= sphere.radius * view.max_scale &&
         IsInFront(sphere, view.forward);
}

// A sphere in front of the camera, projected to the film plane.
struct ProjectedSphere {
  Vec3d center;          // near the point where the line to the sphere's centre crosses the plane
  Vec3d rounding_error;  // of `center`: (center depth - the sphere's centre) / radius
  double scale;          // depth / radius
};

// The upper half of v's digits (Veltkamp 1968): products of two halves are exact.
inline double UpperDigits(double v) {
  const double scaled = v * (0x1p27 + 1);
  return scaled - (scaled - v);
}

// Any depth near the sphere's and any point near its projected centre will do, as long as the error
// is known. Both are rounded to half a double's digits: their product is then exact, and so is its
// difference from the centre, with which it agrees in as many digits (Sterbenz).
inline ProjectedSphere MakeProjectedSphere(const TraceSphere& sphere, const Vec3d& forward) {
  const double depth = UpperDigits(sphere.center.dot(forward));
  const double inverse_depth = 1 / depth, inverse_radius = 1 / sphere.radius;
  ProjectedSphere projected;
  projected.scale = depth / sphere.radius;
  for (int c = 0; c < 3; ++c) {
    projected.center[c] = UpperDigits(sphere.center[c] * inverse_depth);
    projected.rounding_error[c] = (projected.center[c] * depth - sphere.center[c]) * inverse_radius;
  }
  return projected;
}

// The hit of the line t direction, with direction . forward = 1.
struct ProjectedHit {
  bool hit = false;
  Vec3d offset{0, 0, 0};
  double along = 0;  // offset . direction
  double root = 0;   // of the discriminant
};

inline ProjectedHit TestProjected(const ProjectedSphere& sphere, const Vec3d& direction,
                                  Products products) {
  ProjectedHit hit;
  double within = 1;  // - |offset|^2
  for (int c = 0; c < 3; ++c) {
    hit.offset[c] =
        MulAdd(direction[c] - sphere.center[c], sphere.scale, sphere.rounding_error[c], products);
    within = MulAdd(-hit.offset[c], hit.offset[c], within, products);
  }
  hit.along = Dot(hit.offset, direction, products);
  const double dd = Dot(direction, direction, products);
  const double discriminant = MulAdd(dd, within, hit.along * hit.along, products);
  hit.hit = discriminant >= 0;
  if (hit.hit) hit.root = std::sqrt(discriminant);
  return hit;
}

// The hit's t, computed from the product of the roots as in TestSphere, which does not cancel where
// the centre's distance is nearly the radius.
inline double ProjectedDepth(const ProjectedHit& hit, const TraceSphere& sphere,
                             const Vec3d& direction, Products products) {
  const double product =
      Dot(sphere.center, sphere.center, products) - sphere.radius * sphere.radius;
  return product /
         MulAdd(sphere.radius, hit.root, Dot(sphere.center, direction, products), products);
}

// The unit normal at the hit: offset - (along + root) direction / |direction|^2. `to_view` is the
// negated direction times `inverse_length`, a unit vector.
inline Vec3d ProjectedNormal(const ProjectedHit& hit, const Vec3d& to_view, double inverse_length,
                             Products products) {
  const double back = (hit.root + hit.along) * inverse_length;
  Vec3d normal;
  for (int c = 0; c < 3; ++c) normal[c] = MulAdd(to_view[c], back, hit.offset[c], products);
  return normal;
}

}  // namespace nacre
