// SPDX-License-Identifier: Apache-2.0
#include "brdf/quadrature.h"

#include <array>
#include <cmath>

namespace nacre {
namespace {

QuadratureRule MakeGaussLegendre(int points) {
  QuadratureRule rule;
  rule.x.resize(static_cast<size_t>(points));
  rule.w.resize(static_cast<size_t>(points));
  for (int i = 0; i < points; ++i) {
    double x = std::cos(M_PI * (i + 0.75) / (points + 0.5));
    double slope = 0;
    for (int step = 0; step < 8; ++step) {  // Newton's method, quadratic from four digits on
      double before = 1;
      double value = x;
      for (int n = 2; n <= points; ++n) {
        const double next = ((2 * n - 1) * x * value - (n - 1) * before) / n;
        before = value;
        value = next;
      }
      slope = points * (x * value - before) / (x * x - 1);
      x -= value / slope;
    }
    rule.x[static_cast<size_t>(i)] = (1 - x) / 2;
    rule.w[static_cast<size_t>(i)] = 1 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

}  // namespace

const QuadratureRule& GaussLegendre(int points) {
  static const auto kRules = [] {
    std::array<QuadratureRule, 33> rules;
    for (int n = 1; n <= 32; ++n) rules[static_cast<size_t>(n)] = MakeGaussLegendre(n);
    return rules;
  }();
  return kRules[static_cast<size_t>(points)];
}

}  // namespace nacre
