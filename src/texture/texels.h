// SPDX-License-Identifier: Apache-2.0
// texture/texels.h: a decoded image as textures are sampled from it: linear floats, with the
// smaller copies of it (mip levels) that stand for many texels at once.
//
// Floats, whatever the file held: filtering is done in linear light, and a filtered sRGB code of 8
// bits would need more than 8 bits to hold it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nacre {

// One size of an image.
struct MipLevel {
  int32_t width, height;
  int32_t first;  // index of its first value in MipChain::values
};

// Rows lie one after the other, row 0 at v = 0 (the bottom of a picture), a texel's channels
// together.
struct MipChain {
  int channels = 1;              // 1 to 4
  std::vector<MipLevel> levels;  // the image itself, then half its size (rounded down) each time
  std::vector<float> values;     // of all levels; indices fit 32 bits

  float Value(size_t level, int x, int y, int channel) const {
    const MipLevel& l = levels[level];
    return values[static_cast<size_t>(l.first) +
                  (static_cast<size_t>(y) * static_cast<size_t>(l.width) + static_cast<size_t>(x)) *
                      static_cast<size_t>(channels) +
                  static_cast<size_t>(channel)];
  }
};

// The most values of an image: with all its levels, 4/3 of that, indices stay below 2^31.
inline constexpr size_t kMaxTexelValues = size_t{1} << 30;

// The image and all of its levels down to 1x1. Each texel of a level is the mean, in double, of the
// rectangle of the level above that it covers, parts of texels by their area: any size, not powers
// of two alone, keeps its mean. `image` holds width x height x channels values.
MipChain MakeMipChain(int width, int height, int channels, std::vector<float> image);

// The same in two steps, for images that are read straight into the chain, which needs no other
// memory than its own: 16/3 bytes a value. Between the two, the image's values are written to the
// first ones of `values`.
MipChain MakeEmptyMipChain(int width, int height, int channels);
void FillMipLevels(MipChain* chain);

}  // namespace nacre
