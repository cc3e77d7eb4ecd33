// SPDX-License-Identifier: Apache-2.0
#include "compare/flip_rows.h"

#include <cmath>

#include "base/aligned.h"

namespace nacre {
namespace {

FlipFilter ToFloat(const Kernel& kernel, double scale_down = 1) {
  const size_t centre = kernel.size() / 2;
  size_t radius = centre;
  for (double left_out = 0; radius > 0; --radius) {
    left_out += 2 * std::abs(kernel[centre + radius]);
    if (left_out > 0x1p-25) break;
  }
  FlipFilter filter;
  filter.full.assign(kFlipBlockRows - 1, 0.0f);
  for (size_t i = centre - radius; i <= centre + radius; ++i) {
    filter.full.push_back(static_cast<float>(scale_down * kernel[i]));
    if (i >= centre) filter.half.push_back(static_cast<float>(kernel[i]));
  }
  filter.full.resize(filter.full.size() + kFlipBlockRows - 1);
  return filter;
}

}  // namespace

FlipWeights MakeFlipWeights(double pixels_per_degree) {
  const FlipFilters filters = MakeFlipFilters(pixels_per_degree);
  FlipWeights weights;
  weights.luminance = ToFloat(filters.luminance);
  weights.red_green = ToFloat(filters.red_green);
  weights.blue_yellow[0] = ToFloat(filters.blue_yellow[0], filters.first_share);
  weights.blue_yellow[1] = ToFloat(filters.blue_yellow[1], 1 - filters.first_share);
  weights.smooth = ToFloat(filters.smooth);
  weights.edge = ToFloat(filters.edge);
  weights.point = ToFloat(filters.point);
  weights.radius = static_cast<size_t>(RadiusOf(filters));
  return weights;
}

size_t FlipLineRoom(size_t radius) { return RoundUp(kFlipColumns + 2 * radius, kBatchPadding); }

}  // namespace nacre
