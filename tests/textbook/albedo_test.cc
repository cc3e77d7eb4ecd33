// SPDX-License-Identifier: Apache-2.0
// tests/textbook/albedo_test.cc: what the lesson's model gives back of light from everywhere: the
// numbers of `nacre explain textbook`, against closed forms and the table of exact integrals.
#include "textbook/albedo.h"

#include <cmath>

#include "catch.h"
#include "tables.h"

namespace nacre {
namespace {

// The lesson's D, F and G as formulas: without the floors and the + 0.0001.
TextbookFaults WithoutEpsilons() {
  TextbookFaults faults;
  faults.denominator_epsilon = faults.distribution_floor = faults.v_dot_h_floor = false;
  return faults;
}

// What the quadrature is good to (2.2e-5 measured); the table is exact to 1e-11.
constexpr double kQuadrature = 3e-5;

TEST_CASE("the lesson's perfect mirror loses more than half") {
  // r -> 0: all light comes from the mirror direction, where G / (n.l n.v) n.l = G1^2 / n.v n.v.
  constexpr double kMirror = 1e-5;
  for (const auto& [n_dot_v, loss] : {std::pair{0.2, 0.556}, std::pair{0.1, 0.779}}) {
    const double albedo = TextbookSpecularAlbedo(n_dot_v, kMirror, 1, WithoutEpsilons());
    CHECK(std::abs(albedo - std::pow(n_dot_v / (n_dot_v * 7 / 8 + 1.0 / 8), 2)) < 1e-4);
    CHECK(std::abs(1 - albedo - loss) < 5e-4);  // as printed, three digits
  }
}

TEST_CASE("right geometry takes nothing from the mirror") {
  CHECK(std::abs(TextbookSpecularAlbedo(0.2, 1e-5, 1, NoFaults()) - 1) < 1e-4);
  // r = 1 in closed form: 1 - mu ln(1 + 1 / mu).
  CHECK(std::abs(TextbookSpecularAlbedo(0.3, 1, 1, NoFaults()) -
                 (1 - 0.3 * std::log(1 + 1 / 0.3))) < 1e-4);
}

TEST_CASE("the lesson's white dielectric makes light from nothing") {
  const auto total = [](double n_dot_v, const TextbookFaults& faults) {
    return TextbookSpecularAlbedo(n_dot_v, 0.02, 0.04, faults) +
           TextbookDiffuseAlbedo(n_dot_v, 0.04, faults);
  };
  CHECK(std::abs(total(0.18, WithoutEpsilons()) - 1.100) < 5e-4);  // as printed, three digits
  // The same base under a gloss that loses nothing makes more.
  CHECK(std::abs(total(0.18, NoFaults()) - 1.34) < 5e-3);
  CHECK(std::abs(total(0.02, NoFaults()) - 1.84) < 5e-3);
}

TEST_CASE("a rough metal loses light either way") {
  CHECK(std::abs(1 - TextbookSpecularAlbedo(1, 1, 1, WithoutEpsilons()) - 0.69) < 5e-3);
}

TEST_CASE("average albedos are the table's", "[table]") {
  const nlohmann::json table = LoadTable("energy");
  REQUIRE_FALSE(table.at("average").empty());
  for (const auto& row : table.at("average")) {
    const double roughness = row.at("roughness").get<double>();
    if (roughness != 0.05 && roughness != 0.5 && roughness != 1) continue;  // half a second each
    CAPTURE(roughness);
    const auto average = [&](const TextbookFaults& faults) {
      return AverageAlbedo(
          [&](double n_dot_v) { return TextbookSpecularAlbedo(n_dot_v, roughness, 1, faults); });
    };
    CHECK(std::abs(average(WithoutEpsilons()) - TableNumber(row.at("E_avg_lessonG"))) < 1e-4);
    CHECK(std::abs(average(NoFaults()) - TableNumber(row.at("E_avg_corr"))) < 1e-4);
  }
}

TEST_CASE("directional albedos are the table's", "[table]") {
  const nlohmann::json table = LoadTable("energy");
  REQUIRE_FALSE(table.at("dfg").empty());
  for (const auto& row : table.at("dfg")) {
    const double roughness = row.at("roughness").get<double>();
    const double n_dot_v = row.at("mu").get<double>();
    CAPTURE(roughness, n_dot_v);
    const double lesson = TextbookSpecularAlbedo(n_dot_v, roughness, 1, WithoutEpsilons());
    CHECK(std::abs(lesson - TableNumber(row.at("E_lessonG"))) < kQuadrature);
    const double base = TextbookDiffuseAlbedo(n_dot_v, 0, WithoutEpsilons());
    CHECK(std::abs(base - TableNumber(row.at("diffuse_coupling"))) < kQuadrature);
  }
}

}  // namespace
}  // namespace nacre
