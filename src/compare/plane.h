// SPDX-License-Identifier: Apache-2.0
// compare/plane.h: pictures as planes of floats, views of pictures and the way of showing them, and
// filter weights, for metrics that look at neighbourhoods.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace nacre {

// One number per pixel, row by row.
struct Plane {
  int width = 0, height = 0;
  std::vector<float> values;

  Plane() = default;
  Plane(int width, int height, float value = 0);
  float& at(int x, int y) { return values[Index(x, y)]; }
  float at(int x, int y) const { return values[Index(x, y)]; }
  size_t size() const { return values.size(); }

 private:
  size_t Index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
};

// The mean, summed in double row by row.
double Mean(const Plane& plane);
double Largest(const Plane& plane);

// Weights of the pixels at -r .. r.
using Kernel = std::vector<double>;

// exp(-x^2 / (2 sigma^2)) at -radius .. radius, scaled to a sum of 1.
Kernel GaussianKernel(double sigma, int radius);

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
