// SPDX-License-Identifier: Apache-2.0
// visibility/sphere_test.h: the ray-sphere test that decides every hit. SIMD twin:
// sphere_test-inl.h, the same operations in the same order: in double both give the same bits.
#pragma once

#include <cmath>

#include "base/vec.h"
#include "visibility/two_product.h"

namespace nacre {

// Distances along the ray are in units of its direction.
template <typename Real>
struct SphereHit {
  bool hit = false;     // there is a root t > 0
  bool inside = false;  // the ray starts inside: t is the far root
  Real t = 0;           // the first root > 0
  Real half_chord = 0;  // half the distance between the roots
  // Set for rays that miss too:
  Real closest = 0;                          // where the ray is nearest to the centre
  Imath::Vec3<Real> perpendicular{0, 0, 0};  // from there to the centre
};

// The first point of the ray t direction, t > 0, on the sphere of this radius about to_center.
//
// The discriminant is radius^2 - |perpendicular|^2 (Haines et al. 2019, Ray Tracing Gems ch. 7),
// so the distance to the sphere does not enter it, but through the rounding of the perpendicular:
// the products closest * direction cancel against to_center and are therefore formed exactly, and
// the component along the ray that the rounding of `closest` leaves is taken off once more. What
// remains is a few roundings of the radius at any distance.
//
// The roots come from their sum and their product, (|to_center|^2 - radius^2) / |direction|^2,
// so the one near the origin does not cancel: a sphere of radius 1e6 under the eye is right.
template <typename Real>
SphereHit<Real> TestSphere(const Imath::Vec3<Real>& to_center, const Imath::Vec3<Real>& direction,
                           Real radius) {
  const Real inverse_dd = 1 / direction.dot(direction);
  SphereHit<Real> result;
  Real closest = to_center.dot(direction) * inverse_dd;
  Imath::Vec3<Real> perpendicular;
  for (int i = 0; i < 3; ++i) {
    const auto along = TwoProduct(closest, direction[i]);
    perpendicular[i] = (to_center[i] - along.product) - along.error;
  }
  const Real correction = perpendicular.dot(direction) * inverse_dd;
  perpendicular -= direction * correction;
  closest = closest + correction;
  result.closest = closest;
  result.perpendicular = perpendicular;

  const Real radius2 = radius * radius;
  const Real discriminant = radius2 - perpendicular.dot(perpendicular);
  if (!(discriminant >= 0 && radius > 0)) return result;
  const Real half_chord = std::sqrt(discriminant * inverse_dd);
  // Both by the same sign: closest may be 0 with either, in the middle of a sphere.
  const Real larger = closest > 0 ? closest + half_chord : closest - half_chord;
  const Real product = (to_center.dot(to_center) - radius2) * inverse_dd;
  const Real smaller = product / larger;
  const Real near = closest > 0 ? smaller : larger;
  const Real far = closest > 0 ? larger : smaller;
  result.inside = !(near > 0);
  result.t = result.inside ? far : near;
  result.hit = result.t > 0;
  result.half_chord = half_chord;
  return result;
}

// From the sphere's centre to the hit: radius times the outward normal, without forming the hit
// point, whose rounding error would grow with its distance.
template <typename Real>
Imath::Vec3<Real> CenterToHit(const SphereHit<Real>& hit, const Imath::Vec3<Real>& direction) {
  const Imath::Vec3<Real> along = direction * hit.half_chord;
  return hit.inside ? along - hit.perpendicular : -along - hit.perpendicular;
}

}  // namespace nacre
