// SPDX-License-Identifier: Apache-2.0
// sampling/inverse_cdf.h: samples an index with given probabilities by inverting their CDF.
//
// The map from u to the index is monotone, so stratified points stay stratified. An alias table
// (Walker 1977) takes constant time, too, but maps many pieces of the unit interval to a heavy
// index, one from each lighter index that it fills up, and its samples are far less well
// distributed.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nacre {

// Entry i describes index i and, for the search, the i-th of as many equal cells of the unit
// interval as there are indices.
struct CdfEntry {
  double upper;    // the CDF at index i: the end of its part of the interval
  uint32_t first;  // the index in whose part cell i begins, where the search starts
};

// Probabilities are the weights over their sum, to 2^-53 of 1. Weights must be >= 0 and finite; if
// all are 0, every index has the same probability.
std::vector<CdfEntry> MakeInverseCdf(std::span<const double> weights);

// The index of u in [0, 1), and u remapped from the index's part of the interval to [0, 1).
struct CdfPick {
  uint32_t index;
  double remapped;
};

// Chen and Asau 1974: fewer than two steps from the cell's first index on average.
inline CdfPick PickIndex(std::span<const CdfEntry> table, double u) {
  const size_t last = table.size() - 1;
  size_t i =
      table[std::min(static_cast<size_t>(u * static_cast<double>(table.size())), last)].first;
  while (i > 0 && table[i - 1].upper > u)
    --i;  // the product may have been rounded up to the next cell
  while (i < last && table[i].upper <= u) ++i;
  const double lower = i > 0 ? table[i - 1].upper : 0;
  const double remapped = (u - lower) / (table[i].upper - lower);
  return {static_cast<uint32_t>(i), std::clamp(remapped, 0.0, 1 - 0x1p-53)};
}

}  // namespace nacre
