// SPDX-License-Identifier: Apache-2.0
#include "compare/plane.h"

#include <algorithm>
#include <cmath>

namespace nacre {

Plane::Plane(int w, int h, float value)
    : width(w), height(h), values(static_cast<size_t>(w) * static_cast<size_t>(h), value) {}

double Mean(const Plane& plane) {
  double sum = 0;
  for (int y = 0; y < plane.height; ++y) {
    double row = 0;
    for (int x = 0; x < plane.width; ++x) row += plane.at(x, y);
    sum += row;
  }
  return sum / static_cast<double>(plane.size());
}

double Largest(const Plane& plane) {
  return *std::max_element(plane.values.begin(), plane.values.end());
}

Kernel GaussianKernel(double sigma, int radius) {
  Kernel kernel;
  kernel.reserve(2 * static_cast<size_t>(radius) + 1);
  double sum = 0;
  for (int x = -radius; x <= radius; ++x) {
    kernel.push_back(std::exp(-x * x / (2 * sigma * sigma)));
    sum += kernel.back();
  }
  for (double& weight : kernel) weight /= sum;
  return kernel;
}

}  // namespace nacre
