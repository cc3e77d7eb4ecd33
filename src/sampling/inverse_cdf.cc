// sampling/alias_table.cc: Vose 1991, "A Linear Algorithm for Generating Random Numbers with a
// Given Distribution".
#include "sampling/alias_table.h"

#include <numeric>

namespace nacre {

std::vector<AliasEntry> MakeAliasTable(std::span<const double> weights) {
  const size_t count = weights.size();
  std::vector<AliasEntry> table(count);
  for (size_t i = 0; i < count; ++i) table[i] = {1, static_cast<uint32_t>(i)};
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (!(sum > 0)) return table;
  // Every index's probability in cells; those with less than one, and with one or more.
  std::vector<double> cells(count);
  std::vector<uint32_t> small, large;
  small.reserve(count);
  large.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    cells[i] = weights[i] / sum * static_cast<double>(count);
    (cells[i] < 1 ? small : large).push_back(static_cast<uint32_t>(i));
  }
  while (!small.empty() && !large.empty()) {
    const uint32_t less = small.back(), more = large.back();
    small.pop_back();
    table[less] = {static_cast<float>(cells[less]), more};
    cells[more] -= 1 - cells[less];
    if (cells[more] < 1) {
      large.pop_back();
      small.push_back(more);
    }
  }
  // What is left has one cell but for rounding, and keeps it: unless it has nothing at all.
  for (const uint32_t index : small) {
    if (weights[index] == 0) {
      const auto heaviest = std::max_element(weights.begin(), weights.end());
      table[index] = {0, static_cast<uint32_t>(heaviest - weights.begin())};
    }
  }
  return table;
}

}  // namespace nacre
