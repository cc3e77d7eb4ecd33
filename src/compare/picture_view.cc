// SPDX-License-Identifier: Apache-2.0
#include "compare/picture_view.h"

#include <algorithm>

namespace nacre {

void ReadLight(const PictureView& picture, const ShowFunction& show, int x, int y, int count,
               const std::array<float*, 3>& light) {
  // The range of pixels that the picture has, relative to x.
  const int first = std::clamp(-x, 0, count - 1);
  const int end = std::clamp(picture.width - x, 1, count);
  for (size_t c = 0; c < 3; ++c) {
    const float* const row = picture.rgb[c] + static_cast<size_t>(y) * picture.stride;
    float* const to = light[c];
    std::copy(row + (x + first), row + (x + end), to + first);
    std::fill(to, to + first, to[first]);
    std::fill(to + end, to + count, to[end - 1]);
  }
  if (show) show(static_cast<size_t>(count), light[0], light[1], light[2]);
}

}  // namespace nacre
