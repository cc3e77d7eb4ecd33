// SPDX-License-Identifier: Apache-2.0
// tests/base/trig_test.cc: float sine, cosine and arc tangent of base/trig-inl.h against those of
// the library in double, on every target, with the errors that they promise; and the twins in
// double against long double.
#include "base/trig.h"

#include <cmath>
#include <limits>

#include "base/trig_kernel.h"
#include "catch.h"
#include "targets.h"

namespace nacre {
namespace {

constexpr int kSteps = 2000;

bool Close(double got, double exact, double relative) {
  return std::abs(got - exact) <= relative * std::abs(exact);
}

TEST_CASE("sine and cosine of turns are right to 3e-7 of themselves") {
  ForEachTarget([](Target) {
    for (int i = -kSteps; i <= kSteps; ++i) {
      const auto u = static_cast<float>(1.3 * i / kSteps);
      CAPTURE(u);
      // Reduced exactly, so that the rounding of the library's 2 pi does not matter next to the
      // zeros.
      const double reduced = double{u} - std::round(double{u});
      const double quarter = reduced - std::copysign(0.25, reduced);
      CHECK(Close(EvaluateSinTurns(u), std::sin(2 * M_PI * reduced), 3e-7));
      CHECK(Close(EvaluateCosTurns(u), -std::copysign(1, reduced) * std::sin(2 * M_PI * quarter),
                  3e-7));
    }
    for (const float tiny : {1e-30f, -1e-12f}) {
      CHECK(Close(EvaluateSinTurns(tiny), 2 * M_PI * double{tiny}, 3e-7));
    }
    CHECK(EvaluateCosTurns(0.25f) == 0);
    CHECK(EvaluateSinTurns(0.5f) == 0);
  });
}

TEST_CASE("the remainder of the arc tangent and functions of it keep their relative errors") {
  ForEachTarget([](Target) {
    for (int i = -kSteps; i <= kSteps; ++i) {
      const auto x = static_cast<float>(std::exp2(15.0 * i / kSteps));
      CAPTURE(x);
      CHECK(Close(EvaluateAtanRemainder(x), AtanRemainder(double{x}), 1e-6));
      CHECK(Close(EvaluateAtan2Upper(x, 1), std::atan(double{x}), 3e-7));
      CHECK(Close(EvaluateAtan2Upper(x, -1), std::atan2(double{x}, -1.0), 3e-7));
    }
    CHECK(EvaluateAtan2Upper(0, 0) == 0);
    CHECK(EvaluateAtan2Upper(0, -2) == 3.14159265f);
    CHECK(Close(EvaluateAtanRemainder(0), 1.0 / 3, 1e-7));
  });
}

TEST_CASE("in double, too, and across the seam of series and formula") {
  for (int i = -kSteps; i <= kSteps; ++i) {
    const double x = std::exp2(15.0 * i / kSteps);
    CAPTURE(x);
    // (x - atan x) / x^3 loses 2 log2(1 / x) of the 64 bits of a long double.
    if (x > 1e-2) {
      const auto wide = static_cast<long double>(x);
      const long double exact = (wide - std::atan(wide)) / (wide * wide * wide);
      CHECK(Close(AtanRemainder(x), static_cast<double>(exact), 2e-14));
    }
    if (x < 1e-2) CHECK(Close(AtanRemainder(x), 1.0 / 3 - x * x / 5 + x * x * x * x / 7, 1e-11));
    const double angle = 2 * std::atan(x);
    if (x > 0.5 && x < 8) CHECK(Close(ArcExcess(x), angle / std::sin(angle) - 1, 1e-13));
  }
  CHECK(AtanRemainder(0.0) == 1.0 / 3);
}

}  // namespace
}  // namespace nacre
