// SPDX-License-Identifier: Apache-2.0
// brdf/quadrature.h: Gauss-Legendre rules, for integrals of reflection models that have no closed
// form.
#pragma once

#include <cstddef>
#include <vector>

namespace nacre {

// Nodes and weights on [0, 1].
struct QuadratureRule {
  std::vector<double> x, w;
};

// The rule of 1 to 32 points, exact for polynomials of degree 2 points - 1.
const QuadratureRule& GaussLegendre(int points);

// int_0^1 f(x) dx for an f that may be singular at 0: panels that halve towards it.
template <class Function>
double IntegrateTowardsZero(const Function& f, int panels = 40) {
  const QuadratureRule& rule = GaussLegendre(12);
  double sum = 0;
  double end = 1;
  for (int panel = 0; panel < panels; ++panel) {
    const double begin = panel == panels - 1 ? 0 : end / 2;
    for (size_t i = 0; i < rule.x.size(); ++i) {
      sum += rule.w[i] * (end - begin) * f(begin + (end - begin) * rule.x[i]);
    }
    end = begin;
  }
  return sum;
}

}  // namespace nacre
