// SPDX-License-Identifier: Apache-2.0
// base/picture.h: an 8-bit RGB picture, as in PNG files. Text is drawn into it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace nacre {

using Rgb8 = std::array<uint8_t, 3>;

struct Rgb8Picture {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb8;  // row by row, with interleaved R, G and B
};

// A picture of one colour.
inline Rgb8Picture FilledPicture(int width, int height, const Rgb8& color) {
  Rgb8Picture picture{width, height, {}};
  picture.rgb8.resize(3 * static_cast<size_t>(width) * static_cast<size_t>(height));
  for (size_t i = 0; i < picture.rgb8.size(); i += 3) {
    std::copy(color.begin(), color.end(), picture.rgb8.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return picture;
}

}  // namespace nacre
