// SPDX-License-Identifier: Apache-2.0
// tests/color/tone_test.cc: the tone operators in double: against the tables, against independent
// forms of the same curves, and the properties that every operator must have.
#include "color/tone.h"

#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "catch.h"
#include "color/display.h"
#include "tables.h"

namespace nacre {
namespace {

using Color = Imath::Color3<double>;
constexpr double kInf = std::numeric_limits<double>::infinity();

constexpr ToneOperator kAllTones[] = {
    ToneOperator::kNeutral, ToneOperator::kReinhard, ToneOperator::kReinhardExtended,
    ToneOperator::kAces,    ToneOperator::kAgx,      ToneOperator::kNone};

bool Near(double got, double expected, double relative, double absolute = 0) {
  return std::abs(got - expected) <= std::max(relative * std::abs(expected), absolute);
}

TEST_CASE("Reinhard and ACES agree with the table in double", "[color][table]") {
  // The tables' rule: 4 half-ulps, of double here, where coefficients as written are exact enough.
  constexpr double kTolerance = 4 * kHalfUlpDouble;
  const auto rows = LoadTable("tonemap").at("scalar");
  for (const auto& row : rows) {
    const double x = TableNumber(row.at("x"));
    CAPTURE(x);
    CHECK(Near(ToneReinhard(x), TableNumber(row.at("reinhard")), kTolerance));
    const double extended = std::min(TableNumber(row.at("reinhard_ext_white4")), 1.0);
    CHECK(Near(ToneReinhardExtended(x, 4.0), extended, kTolerance));
    CHECK(Near(ToneAces(x), TableNumber(row.at("aces_narkowicz_clamped")), kTolerance));
    CHECK(Near(ToneAces(x), std::min(TableNumber(row.at("aces_narkowicz_raw")), 1.0), kTolerance));
  }
}

TEST_CASE("Neutral agrees with the table in double", "[color][table]") {
  const auto rows = LoadTable("tonemap").at("rgb");
  for (const auto& row : rows) {
    const auto& in = row.at("rgb");
    const Color got =
        ToneNeutral(Color(TableNumber(in[0]), TableNumber(in[1]), TableNumber(in[2])));
    for (int c = 0; c < 3; ++c) {
      const double expected = TableNumber(row.at("khronos_pbr_neutral")[static_cast<size_t>(c)]);
      CAPTURE(in.dump(), c);
      // The tables' rule: 16 half-ulps, or 1e-7 absolute in float, 1e-15 in double.
      CHECK(Near(got[c], expected, 16 * kHalfUlpDouble, 1e-15));
    }
  }
}

TEST_CASE("ACES has the figures of the table of facts", "[color][table]") {
  const auto facts = LoadTable("tonemap_facts");
  CHECK(Near(ToneAces(0.18), TableNumber(facts.at("aces_nark_018")), 4 * kHalfUlpDouble));
  const double reaches_1_at = TableNumber(facts.at("aces_nark_reaches_1_at"));
  CHECK(ToneAces(reaches_1_at * (1 - 1e-9)) < 1);
  CHECK(ToneAces(reaches_1_at * (1 + 1e-9)) == 1);
}

// Sobotka's sigmoid as his AgX.py writes it, with pivots, slope, powers and scales.
long double SobotkaSigmoid(long double x) {
  constexpr long double kPivotX = 10.0L / 16.5L, kPivotY = 0.5L, kSlope = 2;
  const bool toe = x < kPivotX;
  const long double power = toe ? 3.0L : 3.25L;
  const long double scale_x = toe ? kPivotX : 1 - kPivotX;
  const long double scale_y = toe ? kPivotY : 1 - kPivotY;
  const long double magnitude = std::pow(
      std::pow(kSlope * scale_x, -power) * (std::pow(kSlope * scale_x / scale_y, power) - 1),
      -1 / power);
  const long double scale = toe ? -magnitude : magnitude;
  const long double term = kSlope * (x - kPivotX) / scale;
  return scale * term / std::pow(1 + std::pow(term, power), 1 / power) + kPivotY;
}

// The sixth-order polynomial that Wrensch 2023 fits to it.
double WrenschPolynomial(double x) {
  return -0.00232 +
         x * (0.1191 + x * (0.4298 + x * (-6.868 + x * (31.96 + x * (-40.14 + x * 15.5)))));
}

TEST_CASE("The AgX sigmoid is Sobotka's", "[color]") {
  CHECK(agx::kToe == Approx(64 - std::pow(33.0 / 20, 3)).epsilon(1e-15));
  CHECK(agx::kShoulder == Approx(std::pow(4, 3.25) - std::pow(33.0 / 13, 3.25)).epsilon(1e-15));
  double squares = 0;
  for (int i = 0; i <= 10'000; ++i) {
    const double t = i * 1e-4;
    // Rounding of the pivot, half an ulp of 1, times the slope of 2, and of the result.
    CHECK(std::abs(agx::Sigmoid(t) - static_cast<double>(SobotkaSigmoid(t))) <= 4e-16);
    squares += std::pow(agx::Sigmoid(t) - WrenschPolynomial(t), 2);
  }
  // The least-squares polynomial of this degree has his coefficients and his mean squared error of
  // 3.67e-6; rounding the coefficients to the four digits that he prints doubles it.
  CHECK(squares / 10'001 < 8e-6);
  CHECK(squares / 10'001 > 3.6e-6);
}

TEST_CASE("The AgX matrices are each other's inverse", "[color]") {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      double product = 0;
      for (int k = 0; k < 3; ++k) product += agx::kInset.m[i][k] * agx::kOutset.m[k][j];
      CHECK(std::abs(product - (i == j)) <= 1e-14);  // they are printed to 15 digits
    }
  }
}

TEST_CASE("AgX agrees with an independent evaluation", "[color]") {
  // In long double, in the order of the original: matrix, log2, clamp, curve, matrix, 2.2.
  for (const Color& in : {Color(0.18, 0.18, 0.18), Color(1, 0.2, 0.05), Color(12, 3, 0.1),
                          Color(0.001, 0.01, 0.1), Color(0, 0, 5), Color(300, 20, 1)}) {
    long double encoded[3];
    for (int i = 0; i < 3; ++i) {
      long double x = 0;
      for (int k = 0; k < 3; ++k)
        x += static_cast<long double>(agx::kPublishedInset.m[i][k]) * in[k];
      const long double t = (std::log2(x) + 12.4739311883324121L) / 16.5L;
      encoded[i] = SobotkaSigmoid(std::clamp(t, 0.0L, 1.0L));
    }
    const Color got = ToneAgx(in);
    for (int i = 0; i < 3; ++i) {
      long double x = 0;
      for (int k = 0; k < 3; ++k) {
        x += static_cast<long double>(agx::kPublishedOutset.m[i][k]) * encoded[k];
      }
      const long double expected = std::pow(std::clamp(x, 0.0L, 1.0L), 2.2L);
      CAPTURE(in, i);
      // The published matrices, whose rows miss a sum of 1 by 1.4e-4, change a channel's encoded
      // value by as much at most, and its light by 2.2 times that.
      CHECK(std::abs(got[i] - static_cast<double>(expected)) <= 3.1e-4);
    }
  }
}

TEST_CASE("AgX keeps greys grey, and middle grey in the middle", "[color]") {
  for (const double x : {0.001, 0.18, 1.0, 16.0, 1e9}) {
    const Color out = ToneAgx(Color(x, x, x));
    CHECK(std::abs(out.x - out.y) <= 1e-13);  // the matrices are printed to 15 digits
    CHECK(std::abs(out.z - out.y) <= 1e-13);
  }
  CHECK(ToneAgx(Color(0.18, 0.18, 0.18)).y == Approx(std::pow(0.5, 2.2)).epsilon(1e-13));
}

TEST_CASE("Neutral takes off the Fresnel reflection", "[color]") {
  CHECK(DisplayLight(DisplaySettings{}, Color(0.18, 0.18, 0.18)).x == Approx(0.14).epsilon(1e-15));
}

TEST_CASE("Every operator is monotone on greys and stays in [0, 1]", "[color]") {
  std::vector<double> inputs = {0, 1e-320, 4.9e-324};
  for (int i = 0; i < 1'000'000; ++i) inputs.push_back(std::exp2(-149 + i * (277.0 / 999'999)));
  for (const double x : {65504.0, 1e19, 3e38, 1e300, std::numeric_limits<double>::max(), kInf}) {
    inputs.push_back(x);
  }
  std::sort(inputs.begin(), inputs.end());
  for (const ToneOperator tone : kAllTones) {
    CAPTURE(ToneOperatorName(tone));
    DisplaySettings settings{.tone = tone};
    Color previous(0, 0, 0);
    size_t faults = 0;
    for (const double x : inputs) {
      const Color out = DisplayLight(settings, Color(x, x, x));
      for (int c = 0; c < 3; ++c) faults += !(out[c] >= previous[c] && out[c] <= 1);
      previous = out;
    }
    CHECK(faults == 0);
    CHECK(previous.x >= 1 - 1e-13);  // AgX: the digits of its matrices
  }
}

TEST_CASE("Bright colours stay finite and become light", "[color]") {
  for (const ToneOperator tone : kAllTones) {
    CAPTURE(ToneOperatorName(tone));
    DisplaySettings settings{.tone = tone};
    for (const double x : {1e10, 3e38, 1e300, kInf}) {
      const Color out = DisplayLight(settings, Color(x, 0.1, -5));
      for (int c = 0; c < 3; ++c) CHECK((out[c] >= 0 && out[c] <= 1));
      CHECK(out.x > 0.999);
    }
  }
  CHECK(ToneNeutral(Color(1e9, 0, 0)).z > 0.999);  // desaturates to white
}

TEST_CASE("Exposure doubles per stop, before the operator", "[color]") {
  DisplaySettings settings{.tone = ToneOperator::kReinhard, .exposure_ev = 3};
  CHECK(DisplayLight(settings, Color(0.25, 1, 0)) == Color(2.0 / 3, 8.0 / 9, 0));
}

TEST_CASE("Tone operators have names both ways", "[color]") {
  CHECK(ToneOperatorNames().size() == std::size(kAllTones));
  for (const ToneOperator tone : kAllTones)
    CHECK(ParseToneOperator(ToneOperatorName(tone)) == tone);
  try {
    ParseToneOperator("reinhart");
    FAIL("accepted");
  } catch (const Error& error) {
    CHECK(error.code() == ExitCode::kUsage);
    CHECK(error.faults().at(0).hint == "did you mean \"reinhard\"?");
  }
}

}  // namespace
}  // namespace nacre
