// SPDX-License-Identifier: Apache-2.0
// tests/base/math_test.cc: the float logarithms, exponential and roots of src/base against those of
// the library in double, on every target, with the errors that they promise.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/float_mode.h"
#include "base/math_kernel.h"
#include "catch.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr int kSteps = 2000;

double RelativeError(double got, double exact) { return std::abs(got - exact) / std::abs(exact); }

TEST_CASE("log2 is right to 2e-7 over all normal floats") {
  ForEachTarget([](Target) {
    for (int i = 0; i <= kSteps; ++i) {
      const auto x = static_cast<float>(std::exp2(-126 + 253.99 * i / kSteps));
      CAPTURE(x);
      const double exact = std::log2(double{x});
      // Absolute within an octave of 1, where the logarithm has a root.
      CHECK(std::abs(EvaluateLog2(x) - exact) <= 2e-7 * std::max(std::abs(exact), 1.0));
    }
    CHECK(EvaluateLog2(1) == 0);
  });
}

TEST_CASE("log2(1 - x) is right to 2e-7 of itself, however small x is") {
  ForEachTarget([](Target) {
    for (int i = 0; i <= kSteps; ++i) {
      const auto x = static_cast<float>(std::exp2(-100 + 99.9 * i / kSteps));
      CAPTURE(x);
      const auto c = static_cast<float>(1 - double{x});
      const double exact = x < 0.25f ? std::log1p(-double{x}) / M_LN2 : std::log2(double{c});
      CHECK(RelativeError(EvaluateLog2OneMinus(x, c), exact) <= 2e-7);
    }
    // Cosines near 0, and the ends of the table's intervals in an octave.
    for (int i = 0; i <= 100 * 32; ++i) {
      const double end = std::ldexp(1 + (i % 32) / 32.0, -i / 32 - 1);
      for (const double c : {end * (1 - 0x1p-24), end}) {
        CAPTURE(c);
        const auto x = static_cast<float>(1 - c);
        CHECK(RelativeError(EvaluateLog2OneMinus(x, static_cast<float>(c)), std::log2(c)) <= 2e-7);
      }
    }
    CHECK(EvaluateLog2OneMinus(0, 1) == 0);
  });
}

TEST_CASE("2^y is right to 1e-7 and 0 where it would be denormal") {
  ForEachTarget([](Target) {
    for (int i = 0; i < kSteps; ++i) {
      const auto y = static_cast<float>(-125.99 + 253.9 * i / kSteps);
      CAPTURE(y);
      CHECK(RelativeError(EvaluateExp2(y), std::exp2(double{y})) <= 1e-7);
    }
    const FlushDenormals flush;  // as in all threads that shade
    for (const float y : {-126.5f, -1e3f, -1e30f}) CHECK(EvaluateExp2(y) == 0);
    CHECK(EvaluateExp2(0) == 1);
  });
}

// In units of the exact value's last place.
double UlpError(float got, double exact) {
  return std::abs(got - exact) / std::ldexp(1.0, std::ilogb(exact) - 23);
}

// Results depend on the significand only, those of roots also on whether the exponent is odd: 64
// 000 of the 2^24 floats of two octaves are tested, and one of every octave.
std::vector<float> NormalFloats() {
  std::vector<float> x;
  for (int i = 0; i < 64000; ++i) x.push_back(static_cast<float>(1 + 3 * (i + 0.37) / 64000));
  for (int e = -126; e < 126; ++e) x.push_back(static_cast<float>(std::ldexp(1.4142135, e)));
  return x;
}

TEST_CASE("reciprocals and roots are right to the last places that they promise") {
  const std::vector<float> x = NormalFloats();
  ForEachTarget([&](Target) {
    const TargetOps ops = EvaluateTargetOps(x);
    double reciprocal = 0, reciprocal_sqrt = 0, root = 0, twice = 0;
    for (size_t i = 0; i < x.size(); ++i) {
      const double exact = std::sqrt(double{x[i]});
      reciprocal = std::max(reciprocal, UlpError(ops.reciprocal[i], 1 / double{x[i]}));
      reciprocal_sqrt = std::max(reciprocal_sqrt, UlpError(ops.reciprocal_sqrt[i], 1 / exact));
      root = std::max(root, UlpError(ops.square_root[i], exact));
      twice = std::max(twice, UlpError(ops.twice_square_root[i], 2 * exact));
    }
    CAPTURE(reciprocal, reciprocal_sqrt, root, twice);
    CHECK(reciprocal <= 1);
    CHECK(reciprocal_sqrt <= 2);
    CHECK(root <= 1);
    CHECK(twice <= 2);
  });
}

}  // namespace
}  // namespace nacre
