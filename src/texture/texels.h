// SPDX-License-Identifier: Apache-2.0
// texture/texels.h: a decoded image that textures sample: linear floats, with a mip chain.
//
// Always floats, because filtering is done in linear light: a filtered mip level of 8-bit sRGB
// codes needs more than 8 bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/huge_pages.h"

namespace nacre {

// A mip level.
struct MipLevel {
  int32_t width, height;
  int32_t first;  // index of its first value in MipChain::values
};

// Row by row, row 0 at v = 0 (the bottom of a picture), with interleaved channels.
struct MipChain {
  int channels = 1;              // 1 to 4
  std::vector<MipLevel> levels;  // the image itself, then half its size (rounded down) each time
  HugeVector<float> values;      // of all levels; indices fit 32 bits

  float Value(size_t level, int x, int y, int channel) const {
    const MipLevel& l = levels[level];
    return values[static_cast<size_t>(l.first) +
                  (static_cast<size_t>(y) * static_cast<size_t>(l.width) + static_cast<size_t>(x)) *
                      static_cast<size_t>(channels) +
                  static_cast<size_t>(channel)];
  }
};

// The most values of an image, so that the indices of all its levels, 4/3 as many, are below 2^31.
inline constexpr size_t kMaxTexelValues = size_t{1} << 30;

// The image with all levels down to 1x1. Each texel of a level is the mean, computed in double, of
// the rectangle that it covers in the level above, with partly covered texels weighted by area:
// images of any size keep their mean. `image` holds width x height x channels values.
MipChain MakeMipChain(int width, int height, int channels, std::vector<float> image);

// The same in two steps, for images that are decoded directly into the chain, to save memory: it
// takes 16/3 bytes a value. Between the steps the caller writes the image to the beginning of
// `values`.
MipChain MakeEmptyMipChain(int width, int height, int channels);
void FillMipLevels(MipChain* chain);

}  // namespace nacre
