// SPDX-License-Identifier: Apache-2.0
// compare/plane.h: pictures as planes of doubles and their separable filters, for the metrics that
// look at neighbourhoods.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace nacre {

// One number per pixel, row by row.
struct Plane {
  int width = 0, height = 0;
  std::vector<double> values;

  Plane() = default;
  Plane(int width, int height, double value = 0);
  double& at(int x, int y) { return values[Index(x, y)]; }
  double at(int x, int y) const { return values[Index(x, y)]; }
  size_t size() const { return values.size(); }

 private:
  size_t Index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
};

using Planes = std::array<Plane, 3>;

// Weights of the pixels at -r .. r.
using Kernel = std::vector<double>;

// exp(-x^2 / (2 sigma^2)) at -radius .. radius, scaled to the sum of 1.
Kernel GaussianKernel(double sigma, int radius);

// Rows [first, end) of the plane.
Plane RowsOf(const Plane& plane, int first, int end);

// Rows of a band, and of the plane that its filters look at: `radius` more on either side, where
// there are any. Filters of that radius make the same bits of a band as of the whole plane.
struct Band {
  int first, end;              // the band's own rows
  int input_first, input_end;  // with those around it
};

// Bands of a plane of `height` rows: what is worked out of a picture on the way takes memory for
// one of them.
std::vector<Band> BandsOf(int height, int radius);

// Correlates the rows with `across` and the columns with `down`. Beyond its edge the picture goes
// on as its edge is, so that there is no smallest size.
Plane Filter(const Plane& plane, const Kernel& across, const Kernel& down);

}  // namespace nacre
