// SPDX-License-Identifier: Apache-2.0
// tests/light/punctual_test.cc: fall-off of point and spot lights against tables/punctual.json,
// in double and in float on every target, and the rules at the edges.
#include "light/punctual.h"

#include <cmath>
#include <limits>

#include "base/vec.h"
#include "catch.h"
#include "light/punctual_kernel.h"
#include "tables.h"
#include "targets.h"

namespace nacre {
namespace {

struct Expected {
  AttenuationTerms<double> terms;
  double distance;
  double value;
};

struct ExpectedSpot {
  ConeTerms<double> cone;
  double one_minus_cos;
  double value;
  AttenuationTerms<double> terms;  // of the fall-off that is in `total` as well
  double distance, total;
};

AttenuationTerms<float> ToFloat(const AttenuationTerms<double>& terms) {
  return {static_cast<float>(terms.constant), static_cast<float>(terms.linear),
          static_cast<float>(terms.quadratic)};
}

void LoadRows(std::vector<Expected>* falloffs, std::vector<ExpectedSpot>* spots) {
  const nlohmann::json table = LoadTable("punctual");
  for (const auto& row : table.at("rows")) {
    const auto number = [&](const char* key) { return TableNumber(row[key]); };
    const double distance = number("distance");
    falloffs->push_back({{0, 0, 1}, distance, TableNumber(row["inv_sq"])});
    falloffs->push_back({{1e-4, 0, 1}, distance, number("lesson_0p0001")});
    falloffs->push_back({{number("eps"), 0, 1}, distance, TableNumber(row["F3_eps"])});
    falloffs->push_back(
        {{number("Kc"), number("Kl"), number("Kq")}, distance, TableNumber(row["F2_poly"])});
    const double cutoff = number("cos_cutoff");
    spots->push_back({{1 - cutoff, 1 - cutoff, number("exponent")},
                      1 - number("cos_alpha"),
                      number("spot_factor"),
                      {number("eps"), 0, 1},
                      distance,
                      number("spot_total")});
  }
  REQUIRE_FALSE(falloffs->empty());
}

// tables/README: 4u for fall-offs, 8u(exponent + 8) for the spot.
bool Within(double got, double reference, double units, double u) {
  return std::abs(got - reference) <= units * u * std::abs(reference) + 1e-300;
}

TEST_CASE("fall-offs match the table", "[table]") {
  std::vector<Expected> falloffs;
  std::vector<ExpectedSpot> spots;
  LoadRows(&falloffs, &spots);
  for (const Expected& row : falloffs) {
    CHECK(Within(AttenuationFactor(row.terms, row.distance), row.value, 4, kHalfUlpDouble));
  }
  for (const ExpectedSpot& row : spots) {
    CHECK(Within(SpotFactor(row.cone, row.one_minus_cos), row.value, 8 * (row.cone.exponent + 8),
                 kHalfUlpDouble));
    // Both, and the product's own rounding.
    CHECK(
        Within(AttenuationFactor(row.terms, row.distance) * SpotFactor(row.cone, row.one_minus_cos),
               row.total, 8 * (row.cone.exponent + 8) + 5, kHalfUlpDouble));
  }
  ForEachTarget([&](Target) {
    for (const Expected& row : falloffs) {
      CAPTURE(row.distance, row.value);
      CHECK(Within(EvaluateAttenuation({ToFloat(row.terms)}, {static_cast<float>(row.distance)})[0],
                   row.value, 4, kHalfUlpFloat));
    }
    for (const ExpectedSpot& row : spots) {
      CAPTURE(row.one_minus_cos, row.cone.exponent, row.value);
      const float factor = EvaluateSpot({row.cone}, {row.one_minus_cos})[0];
      CHECK(Within(factor, row.value, 8 * (row.cone.exponent + 8), kHalfUlpFloat));
      const float falloff =
          EvaluateAttenuation({ToFloat(row.terms)}, {static_cast<float>(row.distance)})[0];
      CHECK(Within(falloff * factor, row.total, 8 * (row.cone.exponent + 8) + 5, kHalfUlpFloat));
    }
  });
}

TEST_CASE("a light at the shaded point gives nothing, at any attenuation") {
  const float tiny = std::numeric_limits<float>::min();
  ForEachTarget([&](Target) {
    CHECK(EvaluateAttenuation({{0, 0, 1}}, {0.0f})[0] == 0);
    CHECK(EvaluateAttenuation({{1, 0, 0}}, {0.0f})[0] == 0);
    CHECK(EvaluateAttenuation({{1, 0, 0}}, {tiny})[0] == 1);
  });
}

TEST_CASE("a cone is dark at its cutoff, and a penumbra of no width is a hard edge") {
  const double cutoff = 0.5;  // 1 - cos 60 degrees
  ForEachTarget([&](Target) {
    const ConeTerms<double> hard{cutoff, cutoff, 0};
    CHECK(EvaluateSpot({hard}, {cutoff})[0] == 0);
    CHECK(EvaluateSpot({hard}, {std::nextafter(cutoff, 0.0)})[0] == 1);
    const ConeTerms<double> soft{cutoff, 0.25, 0};
    CHECK(EvaluateSpot({soft}, {cutoff})[0] == 0);
    CHECK(EvaluateSpot({soft}, {std::nextafter(cutoff, 0.0)})[0] > 0);
    CHECK(EvaluateSpot({soft}, {0.375})[0] == 0.5f);  // halfway: smoothstep(1/2)
    CHECK(EvaluateSpot({soft}, {0.25})[0] == 1);
    CHECK(EvaluateSpot({soft}, {0.4375})[0] == 0.15625f);  // a quarter of the way: 5/32
    const ConeTerms<double> square{cutoff, 0.25, 0, {1, 0}};
    CHECK(EvaluateSpot({square}, {0.375})[0] == 0.25f);
    CHECK(EvaluateSpot({square}, {0.25})[0] == 1);
    // An exponent below 1: the root of the cosine.
    CHECK(EvaluateSpot({{1, 1, 0.5}}, {0.75})[0] == Approx(0.5f).epsilon(1e-6));
    // A cone wider than a half-space: negative cosines count as 0 for the exponent.
    CHECK(EvaluateSpot({{1.5, 1.5, 2}}, {1.25})[0] == 0);
    CHECK(EvaluateSpot({{1.5, 1.5, 0}}, {1.25})[0] == 1);
  });
  CHECK(SpotFactor<double>({0.5, 0.25, 0}, 0.4375) == 0.15625);
  CHECK(SpotFactor<double>({0.5, 0.25, 0, {1, 0}}, 0.4375) == 0.0625);
  CHECK(SpotFactor<double>({1, 1, 0.5}, 0.75) == Approx(0.5).epsilon(1e-15));
  CHECK(SpotFactor<double>({1.5, 1.5, 2}, 1.25) == 0);
}

TEST_CASE("1 - cos keeps the digits of small angles") {
  CHECK(OneMinusCosine(60) == Approx(0.5).epsilon(1e-15));
  CHECK(OneMinusCosine(180) == 2);
  CHECK(OneMinusCosine(1e-6) == Approx(1.5230870989335429e-16).epsilon(1e-15));
  const double small = 1e-7;
  const Vec3d axis(0, 0, 1), beside(std::sin(small), 0, std::cos(small));
  CHECK(OneMinusCosine(axis, beside) == Approx(5e-15).epsilon(1e-9));
}

}  // namespace
}  // namespace nacre
