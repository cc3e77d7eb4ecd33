// SPDX-License-Identifier: Apache-2.0
// compare/picture_view.h: a view of a picture's colours, and the way of showing them.
#pragma once

#include <array>
#include <cstddef>
#include <functional>

namespace nacre {

// Finite samples of red, green and blue: linear radiance, or display values. Does not own them.
struct PictureView {
  int width = 0, height = 0;
  std::array<const float*, 3> rgb = {};  // at the first pixel
  size_t stride = 0;                     // samples from one row to the next
};

// Converts `count` samples of each channel in place to linear display light in [0, 1] with sRGB
// primaries. Empty: the samples are such light already. Must be thread-safe.
using ShowFunction = std::function<void(size_t count, float* r, float* g, float* b)>;

// How to show a picture and its reference.
struct ShowPair {
  ShowFunction reference, test;
  bool alike = false;  // equal samples of both become equal light
};

// Reads the light of `count` pixels of row `y` from column `x` on. Columns may be beyond the ends
// of the row, where the edge pixel is repeated.
void ReadLight(const PictureView& picture, const ShowFunction& show, int x, int y, int count,
               const std::array<float*, 3>& light);

}  // namespace nacre
