// SPDX-License-Identifier: Apache-2.0
// compare/flip_rows.h: the two steps of FLIP on rows of pixels, in float: filters across, then
// filters down and differences. The kernels are in flip_kernel.cc.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "compare/flip_filters.h"

namespace nacre {

// Pixels that are worked on together: a multiple of two of the widest vectors. Their filtered rows
// stay in L2, and beside them few pixels are shown twice.
inline constexpr size_t kFlipColumns = 128;
// Rows that FlipBlock makes at once: each filtered row is loaded once for all of them.
inline constexpr size_t kFlipBlockRows = 4;

// A symmetric or antisymmetric filter in float. Weights that float's rounding hides, below 2^-25 of
// all, are left out at both ends.
struct FlipFilter {
  std::vector<float> half;  // from the centre on
  std::vector<float> full;  // kFlipBlockRows - 1 zeros before and behind it

  size_t radius() const { return half.size() - 1; }
};

struct FlipWeights {
  FlipFilter luminance, red_green;
  std::array<FlipFilter, 2> blue_yellow;  // `full` times each one's share
  FlipFilter smooth, edge, point;
  size_t radius = 0;  // RadiusOf(filters)
};

FlipWeights MakeFlipWeights(double pixels_per_degree);

// What FilterFlipRow makes of a row.
enum FlipPlane { kLuminance, kRedGreen, kBlueYellow0, kBlueYellow1, kSmooth, kEdge, kPoint };
inline constexpr size_t kFlipPlanes = 7;
inline constexpr size_t kFlipRow = kFlipPlanes * kFlipColumns;  // floats: plane after plane

// Room for a row's light: kFlipColumns and `radius` more on both sides, in whole vectors.
size_t FlipLineRoom(size_t radius);

// Filters a row of light across. Column x of `row` is made of light[x] .. light[x + 2 radius].
// `light` has FlipLineRoom(radius) of each channel, and is overwritten.
void FilterFlipRow(const FlipWeights& weights, const std::array<float*, 3>& light, float* row);

// FLIP of kFlipBlockRows rows of kFlipColumns pixels, row by row to `flip`. Row y of it is made of
// filtered rows y .. y + 2 radius of each picture, the centre among them. `scratch` has
// kFlipScratch floats, aligned.
void FlipBlock(const FlipWeights& weights, const float* const* reference, const float* const* test,
               float* scratch, float* flip);
inline constexpr size_t kFlipScratch = 2 * kFlipPlanes * kFlipBlockRows * kFlipColumns;

}  // namespace nacre
