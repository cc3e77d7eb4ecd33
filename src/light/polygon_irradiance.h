// SPDX-License-Identifier: Apache-2.0
// light/polygon_irradiance.h: the irradiance of a surface under convex polygons. SIMD twin:
// polygon_irradiance-inl.h.
//
// By Lambert 1760 the irradiance is half the sum, over the edges of the polygon's part above the
// horizon, of the angle that an edge subtends times the cosine between the surface's normal and the
// normal of the plane through the edge and the point. In that form the terms of a distant polygon,
// of the order of its angular size, cancel to the order of its square, and those of a strip along
// the horizon to the order of the square of its height. Two rearrangements avoid that:
//
// The sum by chords, for small polygons: an edge from a to b on the unit sphere contributes
// normal.(a x b) and the excess of its arc over its chord. The sum of the former over a closed
// polygon does not change if a x b is replaced by (a - p) x (b - p), and a - p is small for a small
// polygon. p is the pivot below.
//
// The sum by sectors, for polygons along the horizon: an edge contributes the region between it and
// the horizon, the integral of sin^2 of its elevation over its azimuth, which is small for a low
// edge.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/trig.h"
#include "light/rectangle_light.h"
#include "light/triangle_light.h"

namespace nacre {

// Twice the irradiance of the edge between two points on the unit sphere, which are given by their
// offsets from the pivot. The excess of the arc over its chord is (angle - sin(angle)) times the
// cosine of its plane; for an edge along the horizon that is right also where its ends are
// opposite.
template <typename Real>
Real EdgeIrradiance(const Imath::Vec3<Real>& pivot, const Imath::Vec3<Real>& to_a,
                    const Imath::Vec3<Real>& to_b, const Imath::Vec3<Real>& normal) {
  const Imath::Vec3<Real> a = pivot + to_a, chord = to_b - to_a;
  const Imath::Vec3<Real> cross = a % chord;
  const Real sin = cross.length();
  if (!(sin > 0)) return 0;  // no edge, or one through the point
  const Real chord_length = chord.length(), sum_length = (a * 2 + chord).length();
  Real excess;
  if (chord_length < sum_length) {
    const Real tan_half = chord_length / sum_length;
    excess = sin * ArcExcess(tan_half);
  } else {
    excess = 2 * std::atan2(chord_length, sum_length) - sin;
  }
  return (normal ^ (to_a % to_b)) + excess * (normal ^ cross) / sin;
}

// Twice the irradiance of the region between the horizon and the edge from a to b, unit vectors
// that are not below the horizon: the integral of sin^2 of the elevation over the azimuth. It is
// the difference between the edge's azimuth and its arc times the cosine of its plane, and both are
// arc tangents: of c / p, and of |m| / q with m = a x b, c = normal.m and q = a.b = p + the product
// of the heights.
template <typename Real>
Real SectorIrradiance(const Imath::Vec3<Real>& a, const Imath::Vec3<Real>& chord,
                      const Imath::Vec3<Real>& normal) {
  const Real a_height = normal ^ a;
  const Real b_height = a_height + (normal ^ chord);
  const Real heights = a_height * b_height;
  const Real c = normal ^ (a % chord);
  const Real q = 1 - chord.length2() / 2;
  const Real p = q - heights;
  // The squared length of m's component along the horizon.
  const Real across2 = (chord * a_height - a * (b_height - a_height)).length2();
  const Real m2 = c * c + across2;
  if (p > std::abs(c) && q * q > m2) {  // less than an eighth of a turn
    // The power series of both arc tangents, with differences such as c / p - c / q computed in
    // closed form.
    const Real pq = p * q;
    const Real p_tan2 = c * c / (p * p), q_tan2 = m2 / (q * q);
    const Real p_remainder = AtanRemainder(std::sqrt(p_tan2));
    const Real q_remainder = AtanRemainder(std::sqrt(q_tan2));
    const Real cubes =
        (c * c * heights * (q * q + pq + p * p) - across2 * p * p * p) / (pq * pq * pq);
    return c * (heights / pq - p_remainder * cubes - q_tan2 / q * (p_remainder - q_remainder));
  }
  const Real m = std::sqrt(m2), size = std::abs(c);
  if (!(m > 0)) return 0;
  const Real shift = std::atan2(p * across2 / (m + size) - size * heights, p * q + size * m);
  const Real tilt = across2 / (m * (m + size)) * std::atan2(m, q);
  return std::copysign(tilt - shift, c);
}

// Sums of twice the irradiance over a polygon's edges, by chords and by sectors.
template <typename Real>
struct EdgeSums {
  Real chords = 0, sectors = 0;
};

// Adds the part above the horizon of the edge between two vertices, which are given by their
// offsets from the corner. Sets the point where the edge crosses the horizon, if it does.
template <typename Real>
void AddEdge(const Imath::Vec3<Real>& corner, const Imath::Vec3<Real>& pivot,
             const Imath::Vec3<Real>& from, const Imath::Vec3<Real>& to,
             const Imath::Vec3<Real>& normal, EdgeSums<Real>* sums, Imath::Vec3<Real>* enters,
             Imath::Vec3<Real>* leaves) {
  using Vec = Imath::Vec3<Real>;
  const Real from_height = normal ^ (corner + from);
  const Real to_height = normal ^ (corner + to);
  if (from_height <= 0 && to_height <= 0) return;
  Vec a = from, b = to;
  if (from_height < 0) a = from + (to - from) * (from_height / (from_height - to_height));
  if (to_height < 0) b = from + (to - from) * (from_height / (from_height - to_height));
  const Vec to_a = UnitDifference(corner, a), to_b = UnitDifference(corner, b);
  sums->chords += EdgeIrradiance(pivot, to_a, to_b, normal);
  sums->sectors += SectorIrradiance(pivot + to_a, to_b - to_a, normal);
  if (from_height <= 0) *enters = to_a;
  if (to_height <= 0) *leaves = to_b;
}

// The irradiance under a convex polygon, given by its first vertex and the offsets from there to
// all its vertices, of which the first is 0.
template <typename Real, size_t kCount>
Real PolygonIrradiance(const Imath::Vec3<Real>& corner,
                       const std::array<Imath::Vec3<Real>, kCount>& from_corner,
                       const Imath::Vec3<Real>& normal) {
  using Vec = Imath::Vec3<Real>;
  const Vec pivot = corner.normalized();
  const Real orientation = corner ^ (from_corner[1] % from_corner[2]);
  if (orientation == 0) return 0;
  Vec enters(0), leaves(0);
  EdgeSums<Real> sums;
  Real size2 = 0, highest = 0, lowest = 0;
  bool overhead = true;  // the normal meets the polygon
  for (size_t i = 0; i < kCount; ++i) {
    const Vec& from = from_corner[i];
    const Vec& to = from_corner[(i + 1) % kCount];
    AddEdge(corner, pivot, from, to, normal, &sums, &enters, &leaves);
    const Vec unit_offset = UnitDifference(corner, from);
    const Real height = normal ^ (pivot + unit_offset);
    size2 = std::max(size2, unit_offset.length2());
    highest = std::max(highest, height);
    lowest = std::min(lowest, height);
    overhead = overhead && orientation * (normal ^ ((corner + from) % (to - from))) > 0;
  }
  // The error of the sum by chords is of the order of size^2, that of the sum by sectors of the
  // order of size highest^2. If the normal meets the polygon, the sum by sectors misses the zenith.
  const bool low = lowest < 0 || highest * highest * highest * highest < size2;
  const Real twice =
      low && !overhead ? sums.sectors : sums.chords + EdgeIrradiance(pivot, leaves, enters, normal);
  // For a needle next to the point the sum is pure rounding error. It is clamped to that of the
  // hemisphere.
  return std::min(std::abs(twice) / 2, static_cast<Real>(M_PI));
}

template <typename Real>
Real Irradiance(const RectangleLight<Real>& light, const Imath::Vec3<Real>& normal) {
  const std::array<Imath::Vec3<Real>, 4> from_corner{Imath::Vec3<Real>(0), light.edge_x,
                                                     light.edge_x + light.edge_y, light.edge_y};
  return PolygonIrradiance(light.corner, from_corner, normal);
}

template <typename Real>
Real Irradiance(const TriangleLight<Real>& light, const Imath::Vec3<Real>& normal) {
  const std::array<Imath::Vec3<Real>, 3> from_corner{Imath::Vec3<Real>(0), light.edge_x,
                                                     light.edge_y};
  return PolygonIrradiance(light.corner, from_corner, normal);
}

}  // namespace nacre
