// SPDX-License-Identifier: Apache-2.0
#include "brdf/tabulated_warp.h"

#include <utility>

namespace nacre {

TabulatedWarp MakeTabulatedWarp(SliceAngles angles, size_t width, size_t height,
                                std::vector<float> values) {
  TabulatedWarp warp;
  const size_t slices = angles.count(), nodes = width * height;
  warp.angles = std::move(angles);
  warp.width = width;
  warp.height = height;
  warp.density = std::move(values);
  warp.along_row.resize(slices * nodes);
  warp.up_to_row.resize(slices * height);
  std::vector<double> rows(height), along(nodes);
  for (size_t s = 0; s < slices; ++s) {
    float* const density = warp.density.data() + s * nodes;
    const auto integrate = [&] {
      for (size_t j = 0; j < height; ++j) {
        double sum = 0;
        for (size_t i = 0; i < width; ++i) {
          const size_t at = j * width + i;
          if (i > 0) {
            sum += (double{density[at - 1]} + double{density[at]}) /
                   (2 * static_cast<double>(width - 1));
          }
          along[at] = sum;
        }
        rows[j] = j == 0 ? 0
                         : rows[j - 1] +
                               (along[j * width - 1] + sum) / (2 * static_cast<double>(height - 1));
      }
    };
    integrate();
    if (!(rows.back() > 0)) {
      std::fill_n(density, nodes, 1.0f);
      integrate();
    }
    const double scale = 1 / rows.back();
    for (size_t k = 0; k < nodes; ++k) {
      density[k] = static_cast<float>(density[k] * scale);
      warp.along_row[s * nodes + k] = static_cast<float>(along[k] * scale);
    }
    for (size_t j = 0; j < height; ++j) {
      warp.up_to_row[s * height + j] = static_cast<float>(rows[j] * scale);
    }
  }
  return warp;
}

}  // namespace nacre
