// SPDX-License-Identifier: Apache-2.0
#include "compare/plane.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace nacre {
namespace {

int Radius(const Kernel& kernel) { return static_cast<int>(kernel.size() / 2); }

void FilterRow(const Plane& plane, int y, const Kernel& kernel, Plane* out) {
  const int radius = Radius(kernel);
  for (int x = 0; x < plane.width; ++x) {
    double sum = 0;
    for (int i = -radius; i <= radius; ++i) {
      const int from = std::clamp(x + i, 0, plane.width - 1);
      sum += kernel[static_cast<size_t>(i + radius)] * plane.at(from, y);
    }
    out->at(x, y) = sum;
  }
}

// One row of the columns' filter, row after row as memory lies.
void FilterColumns(const Plane& plane, int y, const Kernel& kernel, Plane* out) {
  const int radius = Radius(kernel);
  for (int i = -radius; i <= radius; ++i) {
    const int from = std::clamp(y + i, 0, plane.height - 1);
    const double weight = kernel[static_cast<size_t>(i + radius)];
    for (int x = 0; x < plane.width; ++x) out->at(x, y) += weight * plane.at(x, from);
  }
}

}  // namespace

Plane::Plane(int w, int h, double value)
    : width(w), height(h), values(static_cast<size_t>(w) * static_cast<size_t>(h), value) {}

Plane RowsOf(const Plane& plane, int first, int end) {
  Plane rows;
  rows.width = plane.width;
  rows.height = end - first;
  const auto at = [&](int row) {
    return plane.values.begin() + static_cast<std::ptrdiff_t>(row) * plane.width;
  };
  rows.values.assign(at(first), at(end));
  return rows;
}

std::vector<Band> BandsOf(int height, int radius) {
  // As many rows as are looked at beside them, so that the work is at most three times.
  const int rows = std::max(256, radius);
  std::vector<Band> bands;
  for (int first = 0; first < height; first += rows) {
    const int end = std::min(first + rows, height);
    bands.push_back({first, end, std::max(first - radius, 0), std::min(end + radius, height)});
  }
  return bands;
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

Plane Filter(const Plane& plane, const Kernel& across, const Kernel& down) {
  Plane rows(plane.width, plane.height);
  Plane out(plane.width, plane.height);
  const auto height = static_cast<size_t>(plane.height);
  ParallelFor(height, 0, [&](size_t y) { FilterRow(plane, static_cast<int>(y), across, &rows); });
  ParallelFor(height, 0, [&](size_t y) { FilterColumns(rows, static_cast<int>(y), down, &out); });
  return out;
}

}  // namespace nacre
