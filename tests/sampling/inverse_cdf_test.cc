// SPDX-License-Identifier: Apache-2.0
// tests/sampling/inverse_cdf_test.cc: indices have the probabilities that were asked for.
#include "sampling/inverse_cdf.h"

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "catch.h"

namespace nacre {
namespace {

void CheckExact(const std::vector<double>& weights) {
  const std::vector<CdfEntry> table = MakeInverseCdf(weights);
  REQUIRE(table.size() == weights.size());
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  const auto count = static_cast<double>(weights.size());
  size_t wrong = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    const double lower = i > 0 ? table[i - 1].upper : 0;
    // The roundings of two running sums, each of at most `count` terms.
    const double tolerance = count * 0x1p-52;
    if (!(std::abs(table[i].upper - lower - weights[i] / sum) <= tolerance)) ++wrong;
    if (weights[i] == 0 && table[i].upper != lower) ++wrong;
  }
  CHECK(wrong == 0);
  CHECK(table.back().upper == 1);
}

std::vector<std::vector<double>> Distributions() {
  std::vector<std::vector<double>> all = {{1},       {0.5, 0.5}, {3, 0, 0, 1},
                                          {0, 0, 7}, {7, 0, 0},  {1e-30, 1, 1e30}};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const size_t count : {10u, 1000u, 100000u}) {
    std::vector<double> even(count, 0.1), steep(count), sparse(count);
    for (size_t i = 0; i < count; ++i) {
      steep[i] = std::exp(40 * unit(random));
      sparse[i] = unit(random) < 0.01 ? 1 + unit(random) : 0;
    }
    sparse[count / 2] = 1e5;
    all.insert(all.end(), {even, steep, sparse});
  }
  return all;
}

TEST_CASE("the parts of the interval have exactly the lengths asked for", "[sampling]") {
  for (const std::vector<double>& weights : Distributions()) CheckExact(weights);
}

TEST_CASE("a number falls to the index in whose part it lies, wherever that is", "[sampling]") {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const std::vector<double>& weights : Distributions()) {
    const std::vector<CdfEntry> table = MakeInverseCdf(weights);
    size_t wrong = 0;
    const auto check = [&](double u) {
      const CdfPick pick = PickIndex(table, u);
      const double lower = pick.index > 0 ? table[pick.index - 1].upper : 0;
      const bool inside = u >= lower && u < table[pick.index].upper;
      const bool rest =
          pick.remapped >= 0 && pick.remapped < 1 &&
          std::abs(lower + pick.remapped * (table[pick.index].upper - lower) - u) <= 0x1p-50;
      if (!inside || !rest || weights[pick.index] == 0) ++wrong;
    };
    for (int i = 0; i < 20000; ++i) check(unit(random));
    for (const double u : {0.0, 0x1p-53, 0.5, 1 - 0x1p-53}) check(u);
    // The ends of the parts.
    for (size_t i = 0; i < std::min<size_t>(table.size(), 1000); ++i) {
      if (table[i].upper < 1) check(table[i].upper);
      if (table[i].upper > 0) check(std::nextafter(table[i].upper, 0));
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("stratified numbers stay stratified", "[sampling]") {
  // Of n numbers, one in each n-th of the interval, an index of probability p gets n p numbers,
  // within 2.
  const std::vector<double> weights{5, 1, 0, 2, 0.01, 1.99};
  const std::vector<CdfEntry> table = MakeInverseCdf(weights);
  constexpr int kCount = 4096;
  std::vector<int> counts(weights.size());
  for (int i = 0; i < kCount; ++i) ++counts[PickIndex(table, (i + 0.37) / kCount).index];
  for (size_t i = 0; i < weights.size(); ++i) {
    CHECK(std::abs(counts[i] - kCount * weights[i] / 10) < 2);
  }
}

TEST_CASE("without any weight all probabilities are equal", "[sampling]") {
  const std::vector<CdfEntry> table = MakeInverseCdf(std::vector<double>{0, 0, 0, 0});
  for (uint32_t i = 0; i < 4; ++i) CHECK(PickIndex(table, 0.25 * i + 0.1).index == i);
}

}  // namespace
}  // namespace nacre
