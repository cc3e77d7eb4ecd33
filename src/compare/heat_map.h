// SPDX-License-Identifier: Apache-2.0
// compare/heat_map.h: shows the differences of two images, coloured by the logarithm of the error.
#pragma once

#include <cstdint>
#include <string>

#include "base/picture.h"
#include "compare/layers.h"

namespace nacre {

// The colour of t, which is clamped to [0, 1]: dark violet, blue, green, yellow. It is the
// "viridis" map of van der Walt and Smith (2015), whose lightness grows evenly, also for
// colour-blind readers and in print. It is interpolated linearly between ten of its colours, within
// a few codes of the original.
Rgb8 HeatColor(double t);

// Colours of equal samples, and of pixels that are not finite in one image only, where no error is
// defined.
inline constexpr Rgb8 kHeatEqual = {0, 0, 0};
inline constexpr Rgb8 kHeatNotFinite = {255, 0, 255};

// A logarithmic scale from low to high, 0 < low < high.
struct HeatScale {
  double low = 1e-6;
  double high = 1;

  double Position(double error) const;  // t in [0, 1], clamped
};

enum class HeatQuantity : uint8_t { kAbsolute, kRelative };  // as SampleError, SoftenedError

// Shows the largest error of each pixel over the channels of `layer`, over the window that both
// images cover. Throws as PairImages does.
Rgb8Picture HeatMap(const Image& got, const Image& reference, const std::string& layer,
                    HeatQuantity quantity, const HeatScale& scale);

// A bar of all colours, with t growing from left to right.
Rgb8Picture HeatLegend(int width, int height);

}  // namespace nacre
