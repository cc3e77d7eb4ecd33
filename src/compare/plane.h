// SPDX-License-Identifier: Apache-2.0
// compare/plane.h: pictures as planes of floats, and filter weights, for metrics that look at
// neighbourhoods.
#pragma once

#include <array>
#include <cstddef>
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

}  // namespace nacre
