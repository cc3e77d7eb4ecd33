// SPDX-License-Identifier: Apache-2.0
// brdf/chebyshev.h: polynomials through values at Chebyshev nodes, for the albedos' fits.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace nacre {

// The i-th of `terms` nodes in [-1, 1].
inline double ChebyshevNode(size_t i, size_t terms) {
  return std::cos(M_PI * (static_cast<double>(i) + 0.5) / static_cast<double>(terms));
}

// The polynomial that takes the given values at the nodes: coefficients of powers, lowest first.
template <size_t kTerms>
std::array<double, kTerms> InterpolateChebyshev(const std::array<double, kTerms>& values) {
  std::array<double, kTerms> polynomial{};
  // `chebyshev` holds the coefficients of T_j, from the recurrence T_j+1 = 2 z T_j - T_j-1.
  std::array<double, kTerms> before{};
  std::array<double, kTerms> chebyshev{1};
  for (size_t j = 0; j < kTerms; ++j) {
    double weight = 0;
    for (size_t i = 0; i < kTerms; ++i) {
      const double angle = M_PI * (static_cast<double>(i) + 0.5) / static_cast<double>(kTerms);
      weight += values[i] * std::cos(static_cast<double>(j) * angle);
    }
    weight *= (j == 0 ? 1.0 : 2.0) / static_cast<double>(kTerms);
    std::array<double, kTerms> next{};
    for (size_t i = 0; i < kTerms; ++i) {
      polynomial[i] += weight * chebyshev[i];
      next[i] = (i == 0 ? 0 : (j == 0 ? 1.0 : 2.0) * chebyshev[i - 1]) - before[i];
    }
    before = chebyshev;
    chebyshev = next;
  }
  return polynomial;
}

}  // namespace nacre
