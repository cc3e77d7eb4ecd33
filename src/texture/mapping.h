// SPDX-License-Identifier: Apache-2.0
// texture/mapping.h: from points on an object to (u, v), with the gradients of both. SIMD twin:
// mapping-inl.h.
//
// Here z is up, and v = theta / pi is 0 at the north pole, as in textbooks. For scenes with another
// axis, or with v upwards, shading/ rotates the point before the mapping and flips v after it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/vec.h"

namespace nacre {

enum class MappingKind : uint8_t {
  kUv,           // the mesh's own coordinates; a sphere's are spherical
  kSpherical,    // longitude and colatitude
  kCylindrical,  // longitude and height, z from -1 to 1
  kPlanar,       // x and y from -1 to 1
  kCube,         // the whole image on each face of a cube
};

template <typename Real>
struct Mapped {
  Real u, v;
  Imath::Vec3<Real> du, dv;  // gradients
};

// A lower bound of the squared distance from the axis, so that the derivative of the longitude and
// its squares stay in the range of double.
inline constexpr double kMinAxisDistance2 = 1e-290;

// phi / 2 pi with phi = atan2(y, x) in [0, 2 pi), and its gradient, which is the same on both sides
// of the seam. On the axis u is 0 and so is the gradient.
template <typename Real>
void MapLongitude(const Imath::Vec3<Real>& p, Real* u, Imath::Vec3<Real>* du) {
  const Real turn = 2 * static_cast<Real>(M_PI);
  const Real phi = std::atan2(p.y, p.x);
  *u = (phi < 0 ? phi + turn : phi) / turn;
  const Real scale = 1 / (turn * std::max<Real>(p.x * p.x + p.y * p.y, kMinAxisDistance2));
  *du = {-p.y * scale, p.x * scale, 0};
}

// p may have any distance from the centre; the centre itself maps to the equator. theta is
// acos(z / |p|), computed by an arc tangent, which has no cancellation at the poles.
template <typename Real>
Mapped<Real> MapSpherical(const Imath::Vec3<Real>& p) {
  Mapped<Real> mapped;
  MapLongitude(p, &mapped.u, &mapped.du);
  const Real axis2 = std::max<Real>(p.x * p.x + p.y * p.y, kMinAxisDistance2);
  const Real axis = std::sqrt(axis2);
  const Real pi = static_cast<Real>(M_PI);
  mapped.v = std::atan2(axis, p.z) / pi;
  const Real scale = 1 / (pi * (axis2 + p.z * p.z));
  const Real outward = p.z * scale / axis;
  mapped.dv = {p.x * outward, p.y * outward, -axis * scale};
  return mapped;
}

template <typename Real>
Mapped<Real> MapCylindrical(const Imath::Vec3<Real>& p) {
  Mapped<Real> mapped;
  MapLongitude(p, &mapped.u, &mapped.du);
  mapped.v = (p.z + 1) / 2;
  mapped.dv = {0, 0, Real(0.5)};
  return mapped;
}

template <typename Real>
Mapped<Real> MapPlanar(const Imath::Vec3<Real>& p) {
  return {(p.x + 1) / 2, (p.y + 1) / 2, {Real(0.5), 0, 0}, {0, Real(0.5), 0}};
}

// The faces of a cube, numbered as OpenGL's: +x, -x, +y, -y, +z, -z. Equal components go to the
// earlier axis.
template <typename Real>
int CubeFace(const Imath::Vec3<Real>& p) {
  const Imath::Vec3<Real> a(std::abs(p.x), std::abs(p.y), std::abs(p.z));
  if (a.x >= a.y && a.x >= a.z) return p.x < 0 ? 1 : 0;
  if (a.y >= a.z) return p.y < 0 ? 3 : 2;
  return p.z < 0 ? 5 : 4;
}

// OpenGL's s and t on the face of p: u = (s' / m + 1) / 2, where m is the largest absolute
// component, and s' and t' are the two other components with a sign that depends on the face.
template <typename Real>
Mapped<Real> MapCube(const Imath::Vec3<Real>& p) {
  using V = Imath::Vec3<Real>;
  static constexpr int kAxis[6][3] = {{0, 2, 1}, {0, 2, 1}, {1, 0, 2},
                                      {1, 0, 2}, {2, 0, 1}, {2, 0, 1}};  // axes of m, s', t'
  static constexpr int kSign[6][3] = {{1, -1, -1}, {-1, 1, -1}, {1, 1, 1},
                                      {-1, 1, -1}, {1, 1, -1},  {-1, -1, -1}};
  const int face = CubeFace(p);
  const auto& axis = kAxis[face];
  const auto& sign = kSign[face];
  const Real m = std::abs(p[axis[0]]);
  if (!(m > 0)) return {Real(0.5), Real(0.5), V(0), V(0)};
  const auto map = [&](int k, Real* coordinate, V* gradient) {
    const Real ratio = static_cast<Real>(sign[k]) * p[axis[k]] / m;
    *coordinate = (ratio + 1) / 2;
    *gradient = V(0);
    (*gradient)[axis[k]] = static_cast<Real>(sign[k]) / (2 * m);
    (*gradient)[axis[0]] = -static_cast<Real>(sign[0]) * ratio / (2 * m);
  };
  Mapped<Real> mapped;
  map(1, &mapped.u, &mapped.du);
  map(2, &mapped.v, &mapped.dv);
  return mapped;
}

}  // namespace nacre
