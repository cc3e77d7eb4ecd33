// SPDX-License-Identifier: Apache-2.0
// visibility/sphere_test.h: the ray-sphere test that decides every hit. SIMD twin:
// sphere_test-inl.h, the same operations in the same order: in double both give the same bits, if
// the twin is told what the target makes of products.
#pragma once

#include <cmath>

#include "base/vec.h"
#include "visibility/two_product.h"

namespace nacre {

// Whether a sphere's centre is so many radii away that the rounding of `closest` counts where
// `perpendicular` is squared: it is 4 u |to_center| at most, and by as much `perpendicular` is off
// along the ray, which the discriminant's terms, of radius^2, feel by its square. Within 2^20 radii
// that is 2^-62. (Hits feel it as it is: CenterToHit takes it off at any distance.) That is of
// doubles: in float, which studies ask for, no sphere is near enough.
inline constexpr double kNearRadii = 0x1p20;

template <typename Real>
bool IsFarSphere(Real to_center_squared, Real radius) {
  if (sizeof(Real) < sizeof(double)) return true;
  return to_center_squared > static_cast<Real>(kNearRadii * kNearRadii) * (radius * radius);
}

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
// the products closest * direction cancel against to_center and are therefore not rounded, and
// where the component along the ray that the rounding of `closest` leaves would count, it is taken
// off once more (IsFarSphere). What remains is a few roundings of the radius at any distance.
//
// The roots come from their sum and their product, (|to_center|^2 - radius^2) / |direction|^2,
// so the one near the origin does not cancel: a sphere of radius 1e6 under the eye is right.
template <typename Real>
SphereHit<Real> TestSphere(const Imath::Vec3<Real>& to_center, const Imath::Vec3<Real>& direction,
                           Real radius, Products products = Products::kFused) {
  const Real inverse_dd = 1 / Dot(direction, direction, products);
  SphereHit<Real> result;
  Real closest = Dot(to_center, direction, products) * inverse_dd;
  Imath::Vec3<Real> perpendicular;
  for (int i = 0; i < 3; ++i) {
    perpendicular[i] = SubtractProduct(to_center[i], closest, direction[i], products);
  }
  const bool is_far = IsFarSphere(Dot(to_center, to_center, products), radius);
  const Real correction = is_far ? Dot(perpendicular, direction, products) * inverse_dd : 0;
  for (int i = 0; i < 3; ++i) {
    perpendicular[i] = MulAdd(-direction[i], correction, perpendicular[i], products);
  }
  closest = closest + correction;
  result.closest = closest;
  result.perpendicular = perpendicular;

  const Real radius2 = radius * radius;
  const Real discriminant = radius2 - Dot(perpendicular, perpendicular, products);
  if (!(discriminant >= 0 && radius > 0)) return result;
  const Real half_chord = std::sqrt(discriminant * inverse_dd);
  // Both by the same sign: closest may be 0 with either, in the middle of a sphere.
  const Real larger = closest > 0 ? closest + half_chord : closest - half_chord;
  const Real product = (Dot(to_center, to_center, products) - radius2) * inverse_dd;
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
// point, whose rounding error would grow with its distance. What `perpendicular` still has along
// the ray, a rounding of the distance, is taken off.
template <typename Real>
Imath::Vec3<Real> CenterToHit(const SphereHit<Real>& hit, const Imath::Vec3<Real>& direction,
                              Products products = Products::kFused) {
  const Real half_chord = hit.inside ? hit.half_chord : -hit.half_chord;
  const Imath::Vec3<Real>& p = hit.perpendicular;
  const Real inverse_dd = 1 / Dot(direction, direction, products);
  const Real along = MulAdd(Dot(p, direction, products), inverse_dd, half_chord, products);
  return {MulAdd(direction.x, along, -p.x, products), MulAdd(direction.y, along, -p.y, products),
          MulAdd(direction.z, along, -p.z, products)};
}

}  // namespace nacre
