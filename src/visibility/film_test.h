// SPDX-License-Identifier: Apache-2.0
// visibility/film_test.h: the ray-sphere test for most camera rays: fewer operations than that of
// sphere_test.h, and no more rounding. SIMD twin: film_test-inl.h, the same operations in the same
// order.
//
// The directions of a perspective camera's rays end on a plane, direction . forward = 1, the film.
// Where the line to a sphere's centre crosses it, at film_center, is known once for all rays:
//   offset = (direction - film_center) depth / radius
// leads from the sphere's centre to the ray's point at the centre's depth, in radii. Its part along
// the ray tells where the ray is nearest to the centre, and what is left of it how near:
//   discriminant = |direction|^2 (1 - |offset|^2) + (offset . direction)^2,
// that of sphere_test.h over radius^2. There products as large as the sphere's distance cancel, and
// their rounding is made good; here the difference of two places on the film comes first, and loses
// no digit of either. That takes fewer operations, and far fewer where no multiply-add is fused.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vec.h"
#include "hit/camera_frame.h"
#include "visibility/geometry.h"
#include "visibility/sphere_test.h"

namespace nacre {

// Smaller spheres' place on the film is not worth the finding: most of their rays would need
// another one each.
inline constexpr double kLeastFilmRadius = 8;  // in pixels

// So far away, in radii, what a place on the film in half a double's digits is off by, 2^-26 of the
// distance, is still a small part of the sphere.
inline constexpr double kFarthestOnFilm = 0x1p22;

// Where a ray leaves `forward` by an angle, its offset may be 1 / cos of that, whose square the
// discriminant loses: up to 45 degrees, 2, no more than sphere_test.h does to it. In wider views no
// sphere has a place on the film.
inline FilmView MakeFilmView(const CameraFrame& frame) {
  if (frame.projection != Projection::kPerspective || frame.corner.length2() > 2) return {};
  return {frame.forward, std::min(1 / (kLeastFilmRadius * frame.step_x.length()), kFarthestOnFilm)};
}

// All perspective rays leave the plane through the eye perpendicular to `forward` on one side of
// it. So must the sphere lie, by far more than its test errs: whatever lines meet is then before
// the eye.
inline bool IsInFront(const TraceSphere& sphere, const Vec3d& forward) {
  const Vec3d& center = sphere.center;
  const double sum = std::abs(center.x) + std::abs(center.y) + std::abs(center.z) + sphere.radius;
  return center.dot(forward) - sphere.radius > 1e-9 * sum;
}

// Whether the view's rays are tested against the sphere so. By a FilmView of no frame, whose
// forward is 0, nothing lies in front.
inline bool HasFilmPlace(const TraceSphere& sphere, const FilmView& view) {
  return sphere.center.dot(view.forward) <= sphere.radius * view.max_scale &&
         IsInFront(sphere, view.forward);
}

// A sphere in front of the camera as its film has it.
struct FilmSphere {
  Vec3d center;  // near where the line to the sphere's centre crosses the film
  Vec3d rest;    // (center depth - the sphere's centre) / radius: what `center` is off by
  double scale;  // depth / radius
};

// The upper half of v's digits (Veltkamp 1968): products of two halves are exact.
inline double UpperDigits(double v) {
  const double scaled = v * (0x1p27 + 1);
  return scaled - (scaled - v);
}

// Any depth near the sphere's and any place near its centre's will do, as long as what the place is
// off by is known. In half the digits each, their product is exact, and so is its difference from
// the centre, which agrees with it in as many digits (Sterbenz).
inline FilmSphere MakeFilmSphere(const TraceSphere& sphere, const Vec3d& forward) {
  const double depth = UpperDigits(sphere.center.dot(forward));
  const double inverse_depth = 1 / depth, inverse_radius = 1 / sphere.radius;
  FilmSphere film;
  film.scale = depth / sphere.radius;
  for (int c = 0; c < 3; ++c) {
    film.center[c] = UpperDigits(sphere.center[c] * inverse_depth);
    film.rest[c] = (film.center[c] * depth - sphere.center[c]) * inverse_radius;
  }
  return film;
}

// The line of the ray t direction, direction . forward = 1.
struct FilmHit {
  bool hit = false;
  Vec3d offset{0, 0, 0};
  double along = 0;  // offset . direction
  double root = 0;   // of the discriminant
};

inline FilmHit TestOnFilm(const FilmSphere& film, const Vec3d& direction, Products products) {
  FilmHit hit;
  double within = 1;  // - |offset|^2
  for (int c = 0; c < 3; ++c) {
    hit.offset[c] = MulAdd(direction[c] - film.center[c], film.scale, film.rest[c], products);
    within = MulAdd(-hit.offset[c], hit.offset[c], within, products);
  }
  hit.along = Dot(hit.offset, direction, products);
  const double dd = Dot(direction, direction, products);
  const double discriminant = MulAdd(dd, within, hit.along * hit.along, products);
  hit.hit = discriminant >= 0;
  if (hit.hit) hit.root = std::sqrt(discriminant);
  return hit;
}

// The hit's t, from the roots' product as in TestSphere: the centre's distance need not be known
// from the radius's.
inline double FilmDepth(const FilmHit& hit, const TraceSphere& sphere, const Vec3d& direction,
                        Products products) {
  const double product =
      Dot(sphere.center, sphere.center, products) - sphere.radius * sphere.radius;
  return product /
         MulAdd(sphere.radius, hit.root, Dot(sphere.center, direction, products), products);
}

// The unit normal at the hit: offset - (along + root) direction / |direction|^2. `to_view`: minus
// the direction, by `inverse_length` made a unit vector.
inline Vec3d FilmNormal(const FilmHit& hit, const Vec3d& to_view, double inverse_length,
                        Products products) {
  const double back = (hit.root + hit.along) * inverse_length;
  Vec3d normal;
  for (int c = 0; c < 3; ++c) normal[c] = MulAdd(to_view[c], back, hit.offset[c], products);
  return normal;
}

}  // namespace nacre
