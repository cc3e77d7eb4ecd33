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
