// SPDX-License-Identifier: Apache-2.0
// compare/flip_rows.h: the filters of FLIP (Andersson et al. 2020), in double and in float, and its
// two steps on rows of pixels: horizontal filters, then vertical filters and differences. The
// kernels are in flip_kernel.cc.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "compare/plane.h"

namespace nacre {

// ---- Filters, in double -------------------------------------------------------------------------

// One dimension of each filter; all are separable. The filters of contrast sensitivity have a sum
// of 1, and turn opponent colours into perceived ones; that for blue-yellow is first_share *
// blue_yellow[0] + (1 - first_share) * blue_yellow[1].
//
// `edge` and `point` are the first and second derivative of the Gaussian `smooth`, scaled so that a
// step or a dot in [0, 1] gives at most 1; each is applied in one direction with `smooth` in the
// other, both ways round.
struct FlipFilters {
  Kernel luminance, red_green;
  Kernel blue_yellow[2];
  double first_share = 1;
  Kernel smooth, edge, point;
};

FlipFilters MakeFlipFilters(double pixels_per_degree);

// The largest radius of the filters, in pixels.
int RadiusOf(const FlipFilters& filters);

// ---- Rows, in float -----------------------------------------------------------------------------

// Columns that are processed together, a multiple of two of the widest vectors. Their filtered rows
// stay in L2, and few pixels at the borders are converted twice.
inline constexpr size_t kFlipColumns = 128;
// Rows that FlipBlock computes at once, so that each filtered row is loaded once for all of them.
inline constexpr size_t kFlipBlockRows = 4;

// A symmetric or antisymmetric filter in float. At both ends, weights below 2^-25 of the sum are
// dropped, since float would round them away.
struct FlipFilter {
  std::vector<float> half;  // from the centre outwards
  std::vector<float> full;  // with kFlipBlockRows - 1 zeros before and after it

  size_t radius() const { return half.size() - 1; }
};

struct FlipWeights {
  FlipFilter luminance, red_green;
  std::array<FlipFilter, 2> blue_yellow;  // `full` includes each one's share
  FlipFilter smooth, edge, point;
  size_t radius = 0;  // RadiusOf(filters)
};

FlipWeights MakeFlipWeights(double pixels_per_degree);

// The results of FilterFlipRow for a row.
enum FlipPlane { kLuminance, kRedGreen, kBlueYellow0, kBlueYellow1, kSmooth, kEdge, kPoint };
inline constexpr size_t kFlipPlanes = 7;
inline constexpr size_t kFlipRow = kFlipPlanes * kFlipColumns;  // floats, plane after plane

// The size of a buffer for a row of light: kFlipColumns and `radius` more on both sides, in whole
// vectors.
size_t FlipLineRoom(size_t radius);

// Filters a row of light horizontally. Column x of `row` depends on light[x] .. light[x + 2
// radius]. `light` has FlipLineRoom(radius) samples of each channel, and is overwritten.
void FilterFlipRow(const FlipWeights& weights, const std::array<float*, 3>& light, float* row);

// Writes FLIP of kFlipBlockRows rows of kFlipColumns pixels to `flip`, row by row. Row y depends on
// the filtered rows y .. y + 2 radius of each picture, of which the middle one is its own.
// `scratch` has kFlipScratch floats, aligned.
void FlipBlock(const FlipWeights& weights, const float* const* reference, const float* const* test,
               float* scratch, float* flip);
inline constexpr size_t kFlipScratch = 2 * kFlipPlanes * kFlipBlockRows * kFlipColumns;

}  // namespace nacre
