// SPDX-License-Identifier: Apache-2.0
// visibility/sphere_test.h: the ray-sphere test that decides every hit. SIMD twin:
// sphere_test-inl.h, the same operations in the same order: in double both give the same bits, if
// this one is told whether the target fuses products.
#pragma once

#include <cmath>

#include "base/vec.h"
#include "visibility/two_product.h"

namespace nacre {

// The relative rounding error of one operation on floats.
inline constexpr double kFloatUnit = 0x1p-24;

// A sphere as the hit tests read it, relative to the camera.
struct TraceSphere {
  Vec3d center;
  double radius = 0;
};

inline bool Coincide(const TraceSphere& a, const TraceSphere& b) {
  return a.center == b.center && a.radius == b.radius;
}

// Distances along the ray are in units of its direction.
template <typename Real>
struct SphereHit {
  bool hit = false;     // there is a root t > 0
  bool inside = false;  // the ray starts inside: t is the far root
  Real t = 0;           // the first root > 0
  Real root = 0;  // sqrt(discriminant): half the distance between the roots, times |direction|^2
  // Set for rays that miss, too:
  Real closest = 0;                   // where the ray is nearest to the centre
  Imath::Vec3<Real> moment{0, 0, 0};  // to_center x direction
};

// The first point of the ray t direction, t > 0, on the sphere of this radius about to_center.
//
// The length of a line's moment about a point is the length of its direction times its distance
// from the point, so the discriminant is radius^2 |direction|^2 - |moment|^2: that of Haines et al.
// 2019 (Ray Tracing Gems ch. 7) times |direction|^2. The distance to the sphere enters it only
// through the products of the moment, which cancel against each other; their rounding errors are
// therefore compensated. What remains is an error of a few roundings of the radius at any distance.
// And neither a division nor the closest point precedes the square root, on which the hit depends.
// Squares must stay in the range of double: radius |direction| lies within 1e-150 and 1e150 for all
// scenes that are accepted.
//
// The roots come from their sum and their product, (|to_center|^2 - radius^2) / |direction|^2, so
// the one near the origin does not cancel: a sphere of radius 1e6 under the eye is hit accurately.
template <typename Real>
SphereHit<Real> TestSphere(const Imath::Vec3<Real>& to_center, const Imath::Vec3<Real>& direction,
                           Real radius, Products products = Products::kFused) {
  const Real dd = Dot(direction, direction, products);
  const Real inverse_dd = 1 / dd;
  SphereHit<Real> result;
  const Real closest = Dot(to_center, direction, products) * inverse_dd;
  const Imath::Vec3<Real> moment = AccurateCross(to_center, direction, products);
  result.closest = closest;
  result.moment = moment;

  const Real radius2 = radius * radius;
  const Real discriminant = MulAdd(radius2, dd, -Dot(moment, moment, products), products);
  if (!(discriminant >= 0 && radius > 0)) return result;
  result.root = std::sqrt(discriminant);
  const Real half_chord = result.root * inverse_dd;
  // One comparison decides both, because in the middle of a sphere `closest` may be 0 of either
  // sign.
  const Real larger = closest > 0 ? closest + half_chord : closest - half_chord;
  const Real product = (Dot(to_center, to_center, products) - radius2) * inverse_dd;
  const Real smaller = product / larger;
  const Real near = closest > 0 ? smaller : larger;
  const Real far = closest > 0 ? larger : smaller;
  result.inside = !(near > 0);
  result.t = result.inside ? far : near;
  result.hit = result.t > 0;
  return result;
}

// The vector from the sphere's centre to the hit, times |direction|^2, without forming the hit
// point, whose rounding error would grow with its distance. moment x direction leads to the point
// of the line that is nearest to the centre, and root direction from there to the hit; they are
// perpendicular, so nothing cancels.
template <typename Real>
Imath::Vec3<Real> ScaledCenterToHit(const SphereHit<Real>& hit, const Imath::Vec3<Real>& direction,
                                    Products products = Products::kFused) {
  const Real root = hit.inside ? hit.root : -hit.root;
  const auto component = [&](int i, int j, int k) {
    const Real across =
        MulAdd(hit.moment[j], direction[k], -(hit.moment[k] * direction[j]), products);
    return MulAdd(root, direction[i], across, products);
  };
  return {component(0, 1, 2), component(1, 2, 0), component(2, 0, 1)};
}

// Radius times the outward normal.
template <typename Real>
Imath::Vec3<Real> CenterToHit(const SphereHit<Real>& hit, const Imath::Vec3<Real>& direction,
                              Products products = Products::kFused) {
  return ScaledCenterToHit(hit, direction, products) * (1 / Dot(direction, direction, products));
}

}  // namespace nacre
