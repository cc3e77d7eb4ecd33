// SPDX-License-Identifier: Apache-2.0
// compare/heat_map.h: where two images differ, as colours of the logarithm of the error.
#pragma once

#include <cstdint>
#include <string>

#include "base/picture.h"
#include "compare/layers.h"

namespace nacre {

// Colour of t, clamped to [0, 1]: dark violet, blue, green, yellow. The "viridis" map of van der
// Walt and Smith (2015): lightness grows evenly, also for colour-blind readers and in print. Linear
// between ten of its colours, within a few codes of the original.
Rgb8 HeatColor(double t);

// Equal samples, and pixels that are not finite in one image only, which no error measures.
inline constexpr Rgb8 kHeatEqual = {0, 0, 0};
inline constexpr Rgb8 kHeatNotFinite = {255, 0, 255};

// Errors from low to high, 0 < low < high, are spread evenly by their logarithm.
struct HeatScale {
  double low = 1e-6;
  double high = 1;

  double Position(double error) const;  // t in [0, 1], clamped
  double Value(double t) const;         // its inverse: for the tick labels of a legend
};

enum class HeatQuantity : uint8_t { kAbsolute, kRelative };  // as SampleError, SoftenedError

// The largest error of each pixel over the channels of `layer`, over the window that both images
// cover. Throws as PairImages does.
Rgb8Picture HeatMap(const Image& got, const Image& reference, const std::string& layer,
                    HeatQuantity quantity, const HeatScale& scale);

// A bar of all colours, t growing from left to right.
Rgb8Picture HeatLegend(int width, int height);

}  // namespace nacre
