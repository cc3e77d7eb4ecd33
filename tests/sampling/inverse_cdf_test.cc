// tests/sampling/alias_table_test.cc: the alias table has the probabilities that it was made of.
#include "sampling/alias_table.h"

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "catch.h"

namespace nacre {
namespace {

// What the entries add up to for every index, and how many have to do with it.
struct Shares {
  std::vector<double> probability;
  std::vector<int> entries;
};

Shares SharesOf(const std::vector<AliasEntry>& table) {
  Shares shares{std::vector<double>(table.size()), std::vector<int>(table.size())};
  for (size_t i = 0; i < table.size(); ++i) {
    const auto n = static_cast<double>(table.size());
    shares.probability[i] += table[i].threshold / n;
    shares.probability[table[i].alias] += (1 - double{table[i].threshold}) / n;
    ++shares.entries[i];
    if (table[i].threshold < 1) ++shares.entries[table[i].alias];
  }
  return shares;
}

void CheckExact(const std::vector<double>& weights) {
  const std::vector<AliasEntry> table = MakeAliasTable(weights);
  REQUIRE(table.size() == weights.size());
  const Shares shares = SharesOf(table);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  const auto n = static_cast<double>(weights.size());
  double worst = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    // A float's half ulp a threshold, and the roundings of the sums in double.
    const double tolerance = (0x1p-25 * shares.entries[i] + 1e-12) / n;
    worst = std::max(worst, std::abs(shares.probability[i] - weights[i] / sum) / tolerance);
    if (weights[i] == 0 && shares.probability[i] != 0) FAIL("an index of no weight");
  }
  CHECK(worst <= 1);
}

TEST_CASE("alias tables have exactly the probabilities asked for", "[sampling]") {
  CheckExact({1});
  CheckExact({0.5, 0.5});
  CheckExact({3, 0, 0, 1});
  CheckExact({0, 0, 7});
  CheckExact({1e-30, 1, 1e30});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const size_t count : {10u, 1000u, 100000u}) {
    std::vector<double> even(count, 0.1), random_weights(count), steep(count), sparse(count);
    for (size_t i = 0; i < count; ++i) {
      random_weights[i] = unit(random);
      steep[i] = std::exp(40 * unit(random));
      sparse[i] = unit(random) < 0.01 ? 1 + unit(random) : 0;
    }
    sparse[count / 2] = 1e5;
    CheckExact(even);
    CheckExact(random_weights);
    CheckExact(steep);
    CheckExact(sparse);
  }
}

TEST_CASE("a table of no weight has even probabilities", "[sampling]") {
  const Shares shares = SharesOf(MakeAliasTable(std::vector<double>{0, 0, 0, 0}));
  for (const double p : shares.probability) CHECK(p == 0.25);
}

TEST_CASE("picks follow the table, and what is left of the number is uniform", "[sampling]") {
  const std::vector<double> weights{5, 1, 0, 2, 0.01, 1.99};
  const std::vector<AliasEntry> table = MakeAliasTable(weights);
  std::vector<double> counts(weights.size()), rests(weights.size());
  constexpr int kSteps = 1000000;
  for (int i = 0; i < kSteps; ++i) {
    const AliasPick pick = PickAlias(table, (i + 0.5) / kSteps);
    REQUIRE(pick.rest >= 0);
    REQUIRE(pick.rest < 1);
    counts[pick.index] += 1.0 / kSteps;
    rests[pick.index] += pick.rest / kSteps;
  }
  for (size_t i = 0; i < weights.size(); ++i) {
    CAPTURE(i);
    // Even steps miss by less than one at both ends of each of at most 6 stretches.
    CHECK(std::abs(counts[i] - weights[i] / 10) <= 12.0 / kSteps);
    CHECK(std::abs(rests[i] - weights[i] / 20) <= 12.0 / kSteps);
  }
  CHECK(PickAlias(table, 1 - 0x1p-53).index < weights.size());
  CHECK(PickAlias(table, 0).index < weights.size());
}

}  // namespace
}  // namespace nacre
