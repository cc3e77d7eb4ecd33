// sampling/alias_table.h: an index drawn with given probabilities in constant time (Walker 1977).
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace nacre {

// Of the unit interval cut into equal cells, one an index: the part of its cell below `threshold`
// is the index's own, the rest is another's.
struct AliasEntry {
  float threshold;
  uint32_t alias;
};

// Probabilities are weights over their sum, to 2^-25 of a cell for every entry that has to do with
// an index. Weights >= 0 and finite; if all are 0, every index has the same probability.
std::vector<AliasEntry> MakeAliasTable(std::span<const double> weights);

// The index that u in [0, 1) falls to, and what of u is left, uniform in [0, 1) again.
struct AliasPick {
  uint32_t index;
  double rest;
};

inline AliasPick PickAlias(std::span<const AliasEntry> table, double u) {
  const double scaled = u * static_cast<double>(table.size());
  const auto cell =
      std::min(static_cast<uint32_t>(scaled), static_cast<uint32_t>(table.size() - 1));
  const double part = scaled - cell;
  const AliasEntry entry = table[cell];
  const double threshold = entry.threshold;
  const bool own = part < threshold;
  const double rest = own ? part / threshold : (part - threshold) / (1 - threshold);
  return {own ? cell : entry.alias, std::min(rest, 1 - 0x1p-53)};
}

}  // namespace nacre
