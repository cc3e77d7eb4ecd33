// SPDX-License-Identifier: Apache-2.0
// tests/visibility/quad_hits.h: the ray-sphere test in quadruple precision, as the truth.
#pragma once

#include <cmath>

#include "quad.h"
#include "visibility/geometry.h"

namespace nacre {

inline Quad Sqrt(Quad x) {
  if (x == 0) return 0;
  const Quad s = static_cast<Quad>(std::sqrt(static_cast<long double>(x)));
  return (s + x / s) / 2;
}

inline Quad Dot(const Quad (&a)[3], const Quad (&b)[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The textbook test in 113 bits, which is accurate enough for doubles whose magnitudes differ by up
// to 1e7.
struct QuadHit {
  bool hit = false;
  double t = 0;
  double discriminant = 0;  // 1 - (distance of the centre from the line / radius)^2, of misses too
  Quad normal[3] = {0, 0, 0};  // towards the ray
};

inline QuadHit TestInQuad(const Vec3d& origin, const Vec3d& direction, const TraceSphere& sphere) {
  Quad m[3], d[3];
  for (int i = 0; i < 3; ++i) {
    m[i] = static_cast<Quad>(sphere.center[i]) - static_cast<Quad>(origin[i]);
    d[i] = direction[i];
  }
  const Quad r = sphere.radius, dd = Dot(d, d), b = Dot(m, d);
  const Quad discriminant = b * b - dd * (Dot(m, m) - r * r);
  QuadHit result;
  result.discriminant = static_cast<double>(discriminant / (dd * r * r));
  if (discriminant < 0) return result;
  const Quad root = Sqrt(discriminant);
  const bool inside = !(b - root > 0);
  const Quad t = (inside ? b + root : b - root) / dd;
  result.hit = t > 0;
  result.t = static_cast<double>(t);
  for (int i = 0; i < 3; ++i) {
    result.normal[i] = (t * d[i] - m[i]) / r * static_cast<Quad>(inside ? -1 : 1);
  }
  return result;
}

inline double AngleTo(const Quad (&expected)[3], const Vec3d& normal) {
  double square = 0;
  for (int i = 0; i < 3; ++i) {
    const double difference = static_cast<double>(expected[i] - static_cast<Quad>(normal[i]));
    square += difference * difference;
  }
  return std::sqrt(square);  // chord and angle agree for small ones
}

}  // namespace nacre
