// SPDX-License-Identifier: Apache-2.0
#include "image_io/canvas.h"

#include <algorithm>

namespace nacre {

void Canvas::Paste(const Rgb8Picture& picture, const Window& part, int zoom, int left, int top) {
  const int x0 = std::max(left, 0), x1 = std::min(left + zoom * part.width(), picture_.width);
  const int y0 = std::max(top, 0), y1 = std::min(top + zoom * part.height(), picture_.height);
  const auto pixel = [](auto& of, int x, int y) {
    return of.rgb8.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * of.width + x);
  };
  for (int y = y0; y < y1; ++y) {
    const int from = part.y0 + (y - top) / zoom;
    for (int x = x0; x < x1; ++x) {
      std::copy_n(pixel(picture, part.x0 + (x - left) / zoom, from), 3, pixel(picture_, x, y));
    }
  }
}

const Rgb8Picture& Canvas::Draw() {
  if (!text_.empty()) DrawText(picture_.rgb8, picture_.width, picture_.height, text_);
  text_.clear();
  return picture_;
}

}  // namespace nacre
