// SPDX-License-Identifier: Apache-2.0
// brdf/tabulated_warp.h: densities over the unit square that are tabulated for some directions of a
// viewer, and the map that makes uniform points follow them. SIMD twin: tabulated_warp-inl.h.
//
// A slice is the density for one direction of the viewer: bilinear between its nodes, which span
// the square, with an integral of 1. Between slices, the density and its integrals are interpolated
// linearly, so that they stay those of one another. The map is the usual one of a marginal and a
// conditional: the row y follows the integrals of rows, x follows the density along that row.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace nacre {

// The viewer's angles at which there are slices, ascending, in radians. The slice of phi[p] and
// theta[t] has the index p theta.size() + t. With a single phi, the azimuth does not matter.
struct SliceAngles {
  std::vector<float> phi, theta;

  size_t count() const { return phi.size() * theta.size(); }
};

struct TabulatedWarp {
  SliceAngles angles;
  size_t width = 0, height = 0;  // nodes of a slice, at least 2 each; 0: there is no density
  // By slice, row and column: the density at the nodes, and its integral along the row up to the
  // node. By slice and row: the integral over all rows up to this one.
  std::vector<float> density, along_row, up_to_row;

  bool empty() const { return width == 0; }
};

// Makes a warp of densities at nodes, which need not integrate to 1: `values` has width x height of
// them for each slice, none of them negative. A slice of zeros becomes uniform.
TabulatedWarp MakeTabulatedWarp(SliceAngles angles, size_t width, size_t height,
                                std::vector<float> values);

// The neighbouring slices of one direction, and their weights.
struct Slices {
  std::array<size_t, 4> index{};
  std::array<double, 4> weight{};
  size_t count = 0;
};

// The largest i for which the first of two neighbours, i and i + 1, is at most x: of(i) <= x. 0 if
// there is none.
template <class Of>
size_t FindInterval(size_t count, double x, const Of& of) {
  size_t found = 0;
  for (size_t step = size_t{1} << 20; step > 0; step /= 2) {
    if (found + step + 2 <= count && of(found + step) <= x) found += step;
  }
  return found;
}

struct BetweenNodes {
  size_t index;     // of the first of two neighbours
  double fraction;  // from it to the second, in [0, 1]
};

inline BetweenNodes FindAngle(std::span<const float> angles, double angle) {
  if (angles.size() < 2) return {0, 0};
  const size_t i = FindInterval(angles.size(), angle, [&](size_t k) { return double{angles[k]}; });
  const double first = angles[i], second = angles[i + 1];
  return {i, std::clamp((angle - first) / (second - first), 0.0, 1.0)};
}

inline Slices SlicesAt(const SliceAngles& angles, double phi, double theta) {
  const BetweenNodes t = FindAngle(angles.theta, theta), p = FindAngle(angles.phi, phi);
  Slices slices;
  for (size_t row = 0; row < std::min<size_t>(angles.phi.size(), 2); ++row) {
    const double of_row = row == 0 ? 1 - p.fraction : p.fraction;
    const size_t first = (p.index + row) * angles.theta.size() + t.index;
    slices.index[slices.count] = first;
    slices.weight[slices.count++] = of_row * (1 - t.fraction);
    if (angles.theta.size() < 2) continue;
    slices.index[slices.count] = first + 1;
    slices.weight[slices.count++] = of_row * t.fraction;
  }
  return slices;
}

// Entry `at` of each slice, blended: a slice has `stride` entries.
inline double BlendSlices(const Slices& slices, std::span<const float> table, size_t stride,
                          size_t at) {
  double sum = 0;
  for (size_t s = 0; s < slices.count; ++s) {
    sum += slices.weight[s] * double{table[slices.index[s] * stride + at]};
  }
  return sum;
}

// A coordinate in [0, 1] between `count` nodes.
inline BetweenNodes FindNode(size_t count, double x) {
  const double scaled = std::clamp(x, 0.0, 1.0) * static_cast<double>(count - 1);
  const size_t i = std::min(static_cast<size_t>(scaled), count - 2);
  return {i, scaled - static_cast<double>(i)};
}

inline double LerpNodes(double a, double b, double t) { return a * (1 - t) + b * t; }

// Bilinear between the nodes of blended slices; `offset` is that of the table in each slice.
inline double BilinearOfSlices(const Slices& slices, std::span<const float> table, size_t stride,
                               size_t offset, size_t width, size_t height, double x, double y) {
  const BetweenNodes i = FindNode(width, x), j = FindNode(height, y);
  const size_t at = offset + j.index * width + i.index;
  const auto node = [&](size_t k) { return BlendSlices(slices, table, stride, k); };
  return LerpNodes(LerpNodes(node(at), node(at + 1), i.fraction),
                   LerpNodes(node(at + width), node(at + width + 1), i.fraction), j.fraction);
}

struct SquarePoint {
  double x, y;
};

inline double WarpDensity(const TabulatedWarp& warp, const Slices& slices, const SquarePoint& p) {
  return BilinearOfSlices(slices, warp.density, warp.width * warp.height, 0, warp.width,
                          warp.height, p.x, p.y);
}

// The integral of a linear density from 0 to `t` between two nodes with these values; and the t
// that has this integral, in the form of the quadratic's root that does not cancel.
inline double LinearIntegral(double a, double b, double t) { return t * (a + (b - a) * t / 2); }
inline double InvertLinear(double a, double b, double integral) {
  const double root = std::sqrt(std::max(a * a + 2 * integral * (b - a), 0.0));
  const double sum = std::max(a + root, std::numeric_limits<double>::min());
  return std::clamp(2 * integral / sum, 0.0, 1.0);
}

// The uniform point that WarpForward takes to `p`.
inline SquarePoint WarpInverse(const TabulatedWarp& warp, const Slices& slices,
                               const SquarePoint& p) {
  const size_t w = warp.width, h = warp.height;
  const BetweenNodes i = FindNode(w, p.x), j = FindNode(h, p.y);
  const auto along = [&](size_t k) { return BlendSlices(slices, warp.along_row, w * h, k); };
  const auto density = [&](size_t k) { return BlendSlices(slices, warp.density, w * h, k); };
  const size_t row = j.index * w;
  const double of_row = along(row + w - 1), of_next = along(row + 2 * w - 1);
  const double y = BlendSlices(slices, warp.up_to_row, h, j.index) +
                   LinearIntegral(of_row, of_next, j.fraction) / static_cast<double>(h - 1);
  const size_t at = row + i.index;
  const double a = LerpNodes(density(at), density(at + w), j.fraction);
  const double b = LerpNodes(density(at + 1), density(at + w + 1), j.fraction);
  const double x = LerpNodes(along(at), along(at + w), j.fraction) +
                   LinearIntegral(a, b, i.fraction) / static_cast<double>(w - 1);
  const double total = LerpNodes(of_row, of_next, j.fraction);
  return {total > 0 ? x / total : p.x, y};
}

// The point of the density that belongs to a uniform one.
inline SquarePoint WarpForward(const TabulatedWarp& warp, const Slices& slices,
                               const SquarePoint& u) {
  const size_t w = warp.width, h = warp.height;
  const auto along = [&](size_t k) { return BlendSlices(slices, warp.along_row, w * h, k); };
  const auto density = [&](size_t k) { return BlendSlices(slices, warp.density, w * h, k); };
  const auto up_to = [&](size_t k) { return BlendSlices(slices, warp.up_to_row, h, k); };
  const size_t j = FindInterval(h, u.y, up_to);
  const size_t row = j * w;
  const double of_row = along(row + w - 1), of_next = along(row + 2 * w - 1);
  const double y = InvertLinear(of_row, of_next, (u.y - up_to(j)) * static_cast<double>(h - 1));
  const auto along_here = [&](size_t k) {
    return LerpNodes(along(row + k), along(row + w + k), y);
  };
  const double target = u.x * LerpNodes(of_row, of_next, y);
  const size_t i = FindInterval(w, target, along_here);
  const double a = LerpNodes(density(row + i), density(row + w + i), y);
  const double b = LerpNodes(density(row + i + 1), density(row + w + i + 1), y);
  const double x = InvertLinear(a, b, (target - along_here(i)) * static_cast<double>(w - 1));
  return {(static_cast<double>(i) + x) / static_cast<double>(w - 1),
          (static_cast<double>(j) + y) / static_cast<double>(h - 1)};
}

}  // namespace nacre
