// SPDX-License-Identifier: Apache-2.0
// light/environment.h: light from all directions, given by a latitude-longitude image: look-up,
// importance sampling and its pdf. SIMD twin: environment-inl.h. Analytic skies: light/sky.h.
//
// y is up. Row 0 of the image is +y, its left edge -z, its middle +z, and u runs towards +x:
//   direction(u, v) = (sin 2 pi u sin pi v, cos pi v, -cos 2 pi u sin pi v),   u, v in [0, 1].
//
// The radiance is constant over the solid angle of each texel (nearest look-up). Importance
// sampling matches it exactly: a texel is chosen by luminance times solid angle, and the direction
// is uniform in its solid angle. A bilinear look-up would also be bright inside of black texels,
// which are never sampled.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "base/huge_pages.h"
#include "base/vec.h"
#include "sampling/inverse_cdf.h"

namespace nacre {

// Radiance of a texel, and the pdf with which its directions are sampled.
struct EnvironmentTexel {
  float red, green, blue;
  float pdf;
};

// 1 - |cos(theta)| at both edges of a row, and the sign of cos(theta); the cosine itself loses its
// digits at the poles. A row across the equator has the sign of its upper edge, and 1 - cos exceeds
// 1 at its lower one.
struct EnvironmentRow {
  float first, last;
  float sign;
};

struct EnvironmentMap {
  int width = 0, height = 0;
  HugeArray<EnvironmentTexel> texels;  // row by row
  std::vector<EnvironmentRow> rows;
  std::vector<CdfEntry> row_table;
  HugeArray<CdfEntry> column_tables;  // `width` entries a row
  bool is_black = true;               // nothing to sample
};

// Texels in rows from +y on; radiances >= 0 and finite. The map takes 32 bytes a texel. On up to
// `threads` threads (0: as many as the machine has).
EnvironmentMap MakeEnvironmentMap(int width, int height, std::span<const Vec3f> texels,
                                  int threads = 1);

// The solid angle of each texel in a row of an image of this size.
double TexelSolidAngle(int width, int height, int row);

template <typename Real>
struct LatLong {
  Real u, v;
};

template <typename Real>
Imath::Vec3<Real> DirectionFromLatLong(Real u, Real v) {
  const Real pi = static_cast<Real>(M_PI);
  const Real sin = std::sin(pi * v);
  return {std::sin(2 * pi * u) * sin, std::cos(pi * v), -std::cos(2 * pi * u) * sin};
}

// u in [0, 1), v in [0, 1]. By arc tangents, because acos(y) loses its digits at the poles.
template <typename Real>
LatLong<Real> LatLongFromDirection(const Imath::Vec3<Real>& direction) {
  const Real pi = static_cast<Real>(M_PI);
  const Real turn = std::atan2(direction.x, -direction.z) / (2 * pi);
  const Real u = turn < 0 ? turn + 1 : turn;
  return {u < 1 ? u : 0, std::atan2(std::hypot(direction.x, direction.z), direction.y) / pi};
}

template <typename Real>
const EnvironmentTexel& TexelAt(const EnvironmentMap& map, const Imath::Vec3<Real>& direction) {
  const LatLong<Real> at = LatLongFromDirection(direction);
  const int x = std::min(static_cast<int>(at.u * static_cast<Real>(map.width)), map.width - 1);
  const int y = std::min(static_cast<int>(at.v * static_cast<Real>(map.height)), map.height - 1);
  return map
      .texels[static_cast<size_t>(y) * static_cast<size_t>(map.width) + static_cast<size_t>(x)];
}

// A texel chosen by its luminance times its solid angle, and the sample's position in it.
struct EnvironmentPick {
  EnvironmentTexel texel;
  double u;              // image coordinate
  double one_minus_cos;  // 1 - |cos(theta)|, as in EnvironmentRow
  double sign;
};

inline EnvironmentPick PickTexel(const EnvironmentMap& map, double u0, double u1) {
  const CdfPick row = PickIndex(map.row_table, u1);
  const auto width = static_cast<size_t>(map.width);
  const CdfPick column = PickIndex({map.column_tables.data() + row.index * width, width}, u0);
  const EnvironmentRow& edges = map.rows[row.index];
  return {map.texels[row.index * width + column.index],
          (column.index + column.remapped) / static_cast<double>(width),
          edges.first + row.remapped * (double{edges.last} - edges.first), edges.sign};
}

template <typename Real>
struct EnvironmentSample {
  Imath::Vec3<Real> to_light{0, 1, 0};
  EnvironmentTexel texel{0, 0, 0, 0};  // its pdf is the sample's; 0: no sample
};

// A direction by importance sampling; no sample if the environment is black. u0 and u1 should have
// 32 random bits: 24 do not reach dim texels next to a sun.
template <typename Real>
EnvironmentSample<Real> SampleEnvironment(const EnvironmentMap& map, double u0, double u1) {
  if (map.is_black) return {};
  const EnvironmentPick pick = PickTexel(map, u0, u1);
  const double sin = std::sqrt(pick.one_minus_cos * (2 - pick.one_minus_cos));
  const double phi = 2 * M_PI * pick.u;
  return {Imath::Vec3<Real>(Vec3d(std::sin(phi) * sin, pick.sign * (1 - pick.one_minus_cos),
                                  -std::cos(phi) * sin)),
          pick.texel};
}

}  // namespace nacre
