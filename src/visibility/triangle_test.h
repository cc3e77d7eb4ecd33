// SPDX-License-Identifier: Apache-2.0
// visibility/triangle_test.h: the watertight ray-triangle test that decides every hit. SIMD twin:
// triangle_test-inl.h, the same operations in the same order: in double both give the same bits, if
// this one is told whether the target fuses the products in |direction|^2, which spheres need, too.
// All other products are rounded on every target, because the signs of edge functions must not
// depend on which product of a difference is fused.
#pragma once

#include <cmath>

#include "base/vec.h"
#include "visibility/two_product.h"

namespace nacre {

// Shears the ray's direction onto an axis (Woop, Benthin and Wald 2013, JCGT 2(1)): a point p
// relative to the ray's origin projects to (p.x_axis, p.y_axis), which is 0 on the ray.
template <typename Real>
struct RayShear {
  Imath::Vec3<Real> x_axis;
  Imath::Vec3<Real> y_axis;
};

// The axis of the direction's largest component.
template <typename Real>
int ShearAxis(const Imath::Vec3<Real>& direction) {
  const Imath::Vec3<Real> size(std::abs(direction.x), std::abs(direction.y), std::abs(direction.z));
  const bool along_x = size.x >= size.y && size.x >= size.z;
  return along_x ? 0 : (size.y >= size.z ? 1 : 2);
}

template <typename Real>
RayShear<Real> MakeShear(const Imath::Vec3<Real>& direction) {
  const int kz = ShearAxis(direction);
  const int kx = (kz + 1) % 3, ky = (kz + 2) % 3;
  RayShear<Real> shear{Imath::Vec3<Real>(0), Imath::Vec3<Real>(0)};
  shear.x_axis[kx] = 1;
  shear.x_axis[kz] = -(direction[kx] / direction[kz]);
  shear.y_axis[ky] = 1;
  shear.y_axis[kz] = -(direction[ky] / direction[kz]);
  return shear;
}

template <typename Real>
struct TriangleHit {
  bool hit = false;
  Real t = 0;                          // in units of the ray's direction
  Imath::Vec3<Real> weights{0, 0, 0};  // of the three vertices; their sum is 1
  Real area = 0;  // of the projection, twice; its sign is exact, and depends on the winding
};

// The point of the ray t direction, t > 0, on the triangle a b c (relative to the ray's origin),
// seen from either side.
//
// Watertight: a vertex projects to the same point for all triangles that share it, so the
// projection of a closed mesh is closed, and only moved by rounding; and the signs of the edge
// functions are exact (DifferenceOfProducts). Edges and vertices belong to all their triangles.
template <typename Real>
TriangleHit<Real> TestTriangle(const Imath::Vec3<Real>& a, const Imath::Vec3<Real>& b,
                               const Imath::Vec3<Real>& c, const Imath::Vec3<Real>& direction,
                               const RayShear<Real>& shear, Products products = Products::kFused) {
  const Real ax = a.dot(shear.x_axis), ay = a.dot(shear.y_axis);
  const Real bx = b.dot(shear.x_axis), by = b.dot(shear.y_axis);
  const Real cx = c.dot(shear.x_axis), cy = c.dot(shear.y_axis);
  const Real u = DifferenceOfProducts(cx, by, cy, bx);
  const Real v = DifferenceOfProducts(ax, cy, ay, cx);
  const Real w = DifferenceOfProducts(bx, ay, by, ax);
  const Real sum = u + v + w;
  TriangleHit<Real> result;
  const bool front = u >= 0 && v >= 0 && w >= 0;
  const bool back = u <= 0 && v <= 0 && w <= 0;
  if (!(front || back) || sum == 0) return result;  // sum 0: seen edge-on, or without area
  const Real inverse_dd = 1 / Dot(direction, direction, products);
  const Real inverse_sum = 1 / sum;
  result.weights = {u * inverse_sum, v * inverse_sum, w * inverse_sum};
  result.t =
      Imath::Vec3<Real>(a.dot(direction), b.dot(direction), c.dot(direction)).dot(result.weights) *
      inverse_dd;
  result.hit = result.t > 0;
  result.area = sum;
  return result;
}

// Whether the ray of a hit comes from the triangle's front, the side from which its corners run
// counter-clockwise. The shear keeps the winding: its axes and the direction's are cyclic.
template <typename Real>
bool ComesFromFront(const TriangleHit<Real>& hit, const Imath::Vec3<Real>& direction) {
  return (direction[ShearAxis(direction)] > 0) == (hit.area > 0);
}

}  // namespace nacre
