// SPDX-License-Identifier: Apache-2.0
// sampling/inverse_cdf.h: an index drawn with given probabilities by inverting their running sum.
//
// The map from u to the index is monotone, so points that are evenly spread stay so. An alias table
// (Walker 1977) takes constant time, too, but gives an index many pieces of the interval, one of
// each index lighter than it, and what falls to all of them together is far less even.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nacre {

// Of the unit interval cut into as many even cells as there are indices.
struct CdfEntry {
  double upper;    // the index's part of the interval ends here
  uint32_t first;  // the index that this cell begins in: where the search for its points starts
};

// Probabilities are weights over their sum, to 2^-53 of 1. Weights >= 0 and finite; if all are 0,
// every index has the same probability.
std::vector<CdfEntry> MakeInverseCdf(std::span<const double> weights);

// The index that u in [0, 1) falls to, and where in the index's part u lies, in [0, 1).
struct CdfPick {
  uint32_t index;
  double rest;
};

// Chen and Asau 1974: in the mean less than two steps from the cell's first index.
inline CdfPick PickIndex(std::span<const CdfEntry> table, double u) {
  const size_t last = table.size() - 1;
  size_t i =
      table[std::min(static_cast<size_t>(u * static_cast<double>(table.size())), last)].first;
  while (i > 0 && table[i - 1].upper > u) --i;  // the product may have been rounded up to a cell
  while (i < last && table[i].upper <= u) ++i;
  const double lower = i > 0 ? table[i - 1].upper : 0;
  const double rest = (u - lower) / (table[i].upper - lower);
  return {static_cast<uint32_t>(i), std::clamp(rest, 0.0, 1 - 0x1p-53)};
}

}  // namespace nacre
