// SPDX-License-Identifier: Apache-2.0
#include "sampling/inverse_cdf.h"

#include <numeric>

namespace nacre {

std::vector<CdfEntry> MakeInverseCdf(std::span<const double> weights) {
  const size_t count = weights.size();
  std::vector<CdfEntry> table(count);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  double running = 0;
  for (size_t i = 0; i < count; ++i) {
    running += weights[i];
    // Summed in the same order as `sum`, so that it is exactly 1 after the last weight above 0.
    table[i].upper =
        sum > 0 ? running / sum : static_cast<double>(i + 1) / static_cast<double>(count);
  }
  size_t index = 0;
  for (size_t cell = 0; cell < count; ++cell) {
    const double begin = static_cast<double>(cell) / static_cast<double>(count);
    while (index + 1 < count && table[index].upper <= begin) ++index;
    table[cell].first = static_cast<uint32_t>(index);
  }
  return table;
}

}  // namespace nacre
