// SPDX-License-Identifier: Apache-2.0
// render/filter_shares.h: the share of a pixel's samples that lie in a box on the film.
#pragma once

#include <algorithm>
#include <cmath>

#include "render/cell.h"
#include "sampling/pixel_filter.h"

namespace nacre {

// The share of a pixel's samples whose offset from the centre, along one axis, lies between `from`
// and `to`, in pixels.
inline double ShareBetween(const PixelFilter& filter, double from, double to) {
  const auto below = [&](double x) {
    const double inside = FilterIntegral(filter, std::min(std::abs(x), filter.width / 2));
    return x < 0 ? -inside : inside;
  };
  return std::abs(below(to) - below(from));
}

// The pixels of the cell whose samples may lie in the box.
inline Window PixelsOver(const PixelFilter& filter, const Window& cell, const FilmBox& box) {
  const double radius = filter.width / 2;
  const auto first = [&](double at, double half, int from) {
    return std::max(static_cast<int>(std::floor(at - 0.5 - radius - half)), from);
  };
  const auto end = [&](double at, double half, int to) {
    return std::min(static_cast<int>(std::ceil(at - 0.5 + radius + half)) + 1, to);
  };
  return {first(box.x, box.half_width, cell.x0), first(box.y, box.half_height, cell.y0),
          end(box.x, box.half_width, cell.x1), end(box.y, box.half_height, cell.y1)};
}

// Calls add(pixel, share) for each pixel of PixelsOver, with the share of its samples that lies in
// the box.
template <class Add>
void ForEachShare(const PixelFilter& filter, const Window& cell, const FilmBox& box,
                  const Add& add) {
  constexpr int kMaxColumns = 32;  // filters are up to 16 pixels wide, boxes up to 2
  const Window pixels = PixelsOver(filter, cell, box);
  double of_columns[kMaxColumns];
  for (int x = pixels.x0; x < pixels.x1; ++x) {
    const double across = box.x - (x + 0.5);
    of_columns[x - pixels.x0] =
        ShareBetween(filter, across - box.half_width, across + box.half_width);
  }
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    const double down = box.y - (y + 0.5);
    const double of_row = ShareBetween(filter, down - box.half_height, down + box.half_height);
    for (int x = pixels.x0; x < pixels.x1; ++x) {
      add(PixelAt(x - cell.x0, y - cell.y0), of_row * of_columns[x - pixels.x0]);
    }
  }
}

}  // namespace nacre
