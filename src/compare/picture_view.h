// SPDX-License-Identifier: Apache-2.0
// compare/picture_view.h: the colours of a picture that is kept elsewhere, and how they are shown.
#pragma once

#include <array>
#include <cstddef>
#include <functional>

namespace nacre {

// Finite samples of red, green and blue: linear radiance, or the values of a display.
struct PictureView {
  int width = 0, height = 0;
  std::array<const float*, 3> rgb = {};  // of the first pixel
  size_t stride = 0;                     // samples from a row to the next
};

// Makes linear display light in [0, 1], sRGB primaries, of `count` samples of each channel, in
// place. Empty: they are light already. Any thread.
using ShowFunction = std::function<void(size_t count, float* r, float* g, float* b)>;

// How a picture and its reference are shown.
struct ShowPair {
  ShowFunction reference, test;
  bool alike = false;  // equal samples of both become equal light
};

// The light of `count` pixels of row `y` from column `x` on, which may reach beyond both ends of
// the row: there the picture goes on as its edge is.
void ReadLight(const PictureView& picture, const ShowFunction& show, int x, int y, int count,
               const std::array<float*, 3>& light);

}  // namespace nacre
