// SPDX-License-Identifier: Apache-2.0
// tests/chi_squared.h: whether counts of samples follow given probabilities.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace nacre {

// The quantile of chi-squared that a right sampler exceeds with probability 1e-5, nearly (Wilson
// and Hilferty 1931): with under 100 tests in a suite, one false alarm in a thousand suites.
inline double ChiSquaredLimit(size_t degrees) {
  const double v = 2 / (9 * static_cast<double>(degrees));
  return static_cast<double>(degrees) * std::pow(1 - v + 4.265 * std::sqrt(v), 3);
}

// Pearson's test of `counts` out of `total` samples against `probabilities` (of the same bins);
// bins that expect under 5 samples are pooled. A sample where nothing is expected fails.
inline bool FollowsProbabilities(const std::vector<double>& counts, double total,
                                 const std::vector<double>& probabilities) {
  double sum = 0, pooled_count = 0, pooled_expected = 0;
  size_t bins = 0;
  for (size_t i = 0; i < counts.size(); ++i) {
    const double expected = total * probabilities[i];
    if (expected < 5) {
      pooled_count += counts[i];
      pooled_expected += expected;
      continue;
    }
    sum += (counts[i] - expected) * (counts[i] - expected) / expected;
    ++bins;
  }
  if (pooled_expected >= 5) {
    sum += (pooled_count - pooled_expected) * (pooled_count - pooled_expected) / pooled_expected;
    ++bins;
  } else if (pooled_count > 5 + 10 * pooled_expected) {
    return false;
  }
  return bins < 2 || sum <= ChiSquaredLimit(bins - 1);
}

}  // namespace nacre
