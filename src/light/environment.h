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
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "base/huge_pages.h"
#include "base/vec.h"
#include "color/luminance.h"
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

// The number of texels in a block. Blocks do not cross rows, so the last one of a row may be
// shorter.
inline constexpr size_t kEnvironmentBlock = 16;

// Entry i describes block i of a row and, for the search, the i-th of as many equal cells of the
// unit interval as the row has blocks. A table with an entry for each texel would be larger than
// the image, and a search among the texels of a block reads fewer cache lines than one in such a
// table.
struct EnvironmentBlock {
  double sum;      // sum of the row's luminances up to the end of the block
  uint32_t first;  // the block in whose part cell i begins, where the search starts
};

struct EnvironmentMap {
  int width = 0, height = 0;
  std::shared_ptr<const Vec3f[]> texels;  // row by row; shared with the image, not copied
  std::vector<EnvironmentRow> rows;
  std::vector<CdfEntry> row_table;
  std::vector<double> row_sums;        // the sum of luminances of each row
  size_t row_blocks = 0;               // the number of blocks per row
  HugeArray<EnvironmentBlock> blocks;  // row by row
  double sum = 0;                      // luminance times solid angle, summed over all texels
  bool is_black = true;                // nothing to sample
};

// `texels` are rows from +y on; radiances must be >= 0 and finite. The map takes one byte per texel
// beside the texels themselves. Uses up to `threads` threads (0: as many as the machine has).
EnvironmentMap MakeEnvironmentMap(int width, int height, std::shared_ptr<const Vec3f[]> texels,
                                  int threads = 1);

// The luminance by which texels are chosen. Denormals count as 0 in every floating-point mode, as
// they do in renders.
inline double TexelLuminance(const Vec3f& texel) {
  const auto seen = [](float x) {
    return x >= std::numeric_limits<float>::min() ? double{x} : 0.0;
  };
  return Luminance(Rgb(seen(texel.x), seen(texel.y), seen(texel.z)));
}

// The texel with its pdf per solid angle: the probability, luminance times solid angle over the sum
// of all, divided by the solid angle.
inline EnvironmentTexel TexelOf(const EnvironmentMap& map, size_t index) {
  const Vec3f& t = map.texels[static_cast<ptrdiff_t>(index)];
  const double pdf = map.is_black ? 0 : static_cast<float>(TexelLuminance(t)) / map.sum;
  return {t.x, t.y, t.z, static_cast<float>(pdf)};
}

// The solid angle of each texel in a row of an image of this size.
double TexelSolidAngle(int width, int height, int row);

template <typename Real>
struct LatLong {
  Real u, v;
};

// Returns u in [0, 1), v in [0, 1]. Both are arc tangents, because acos(y) loses its digits at the
// poles.
template <typename Real>
LatLong<Real> LatLongFromDirection(const Imath::Vec3<Real>& direction) {
  const Real pi = static_cast<Real>(M_PI);
  const Real turn = std::atan2(direction.x, -direction.z) / (2 * pi);
  const Real u = turn < 0 ? turn + 1 : turn;
  return {u < 1 ? u : 0, std::atan2(std::hypot(direction.x, direction.z), direction.y) / pi};
}

template <typename Real>
size_t TexelIndexAt(const EnvironmentMap& map, const Imath::Vec3<Real>& direction) {
  const LatLong<Real> at = LatLongFromDirection(direction);
  const int x = std::min(static_cast<int>(at.u * static_cast<Real>(map.width)), map.width - 1);
  const int y = std::min(static_cast<int>(at.v * static_cast<Real>(map.height)), map.height - 1);
  return static_cast<size_t>(y) * static_cast<size_t>(map.width) + static_cast<size_t>(x);
}

template <typename Real>
EnvironmentTexel TexelAt(const EnvironmentMap& map, const Imath::Vec3<Real>& direction) {
  return TexelOf(map, TexelIndexAt(map, direction));
}

// A texel chosen by its luminance times its solid angle, and the sample's position in it.
struct EnvironmentPick {
  size_t texel;
  double u;              // image coordinate
  double one_minus_cos;  // 1 - |cos(theta)|, as in EnvironmentRow
  double sign;
};

// The column of the texel in a row that is not black, bit for bit as PickIndex would choose it from
// a table of the row's luminances.
inline CdfPick FindColumn(const EnvironmentMap& map, size_t row, double u) {
  const size_t width = static_cast<size_t>(map.width), last = map.row_blocks - 1;
  const EnvironmentBlock* const blocks = &map.blocks[row * map.row_blocks];
  const double total = map.row_sums[row];
  const size_t cell = std::min(static_cast<size_t>(u * static_cast<double>(last + 1)), last);
  size_t block = blocks[cell].first;
  while (block > 0 && blocks[block - 1].sum / total > u) --block;
  while (block < last && !(blocks[block].sum / total > u)) ++block;
  const Vec3f* const texels = &map.texels[static_cast<ptrdiff_t>(row * width)];
  double before = block > 0 ? blocks[block - 1].sum : 0;
  size_t x = block * kEnvironmentBlock;
  double sum = before + TexelLuminance(texels[x]);
  while (x + 1 < width && !(sum / total > u)) {
    before = sum;
    sum += TexelLuminance(texels[++x]);
  }
  const double lower = before / total;
  return {static_cast<uint32_t>(x),
          std::clamp((u - lower) / (sum / total - lower), 0.0, 1 - 0x1p-53)};
}

inline EnvironmentPick PickTexel(const EnvironmentMap& map, double u0, double u1) {
  const CdfPick row = PickIndex(map.row_table, u1);
  const CdfPick column = FindColumn(map, row.index, u0);
  const auto width = static_cast<size_t>(map.width);
  const EnvironmentRow& edges = map.rows[row.index];
  return {row.index * width + column.index,
          (column.index + column.remapped) / static_cast<double>(width),
          edges.first + row.remapped * (double{edges.last} - edges.first), edges.sign};
}

template <typename Real>
struct EnvironmentSample {
  Imath::Vec3<Real> to_light{0, 1, 0};
  EnvironmentTexel texel{0, 0, 0, 0};  // its pdf is that of the sample; 0: no sample
};

// Samples a direction by importance. There is no sample if the environment is black. u0 and u1
// should have 32 random bits: 24 do not reach dim texels next to a sun.
template <typename Real>
EnvironmentSample<Real> SampleEnvironment(const EnvironmentMap& map, double u0, double u1) {
  if (map.is_black) return {};
  const EnvironmentPick pick = PickTexel(map, u0, u1);
  const double sin = std::sqrt(pick.one_minus_cos * (2 - pick.one_minus_cos));
  const double phi = 2 * M_PI * pick.u;
  return {Imath::Vec3<Real>(Vec3d(std::sin(phi) * sin, pick.sign * (1 - pick.one_minus_cos),
                                  -std::cos(phi) * sin)),
          TexelOf(map, pick.texel)};
}

}  // namespace nacre
