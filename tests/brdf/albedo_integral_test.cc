// SPDX-License-Identifier: Apache-2.0
// tests/brdf/albedo_integral_test.cc: the quadratures behind the albedo fits, and the lobes of the
// Phong family, against the reference tables.
#include "brdf/albedo_integral.h"

#include <cmath>

#include "brdf/fresnel.h"
#include "brdf/multi_scatter.h"
#include "brdf/phong.h"
#include "brdf/quadrature.h"
#include "catch.h"
#include "tables.h"

namespace nacre {
namespace {

// The tables' pass rule for a generator.
constexpr double kTableTolerance = 1e-6;

double One(double, double) { return 1; }

// 2 int AlbedoOfOne mu dmu. The albedo bends at n.v = alpha and has a logarithm in its slope at 0.
double AverageAlbedoOfOne(Shadowing shadowing, double roughness) {
  return IntegrateTowardsZero(
      [&](double mu) { return 2 * mu * AlbedoOfOne(shadowing, roughness, mu); });
}

TEST_CASE("albedos for F = 1 are the table's", "[table]") {
  const nlohmann::json table = LoadTable("ggx_albedo");
  REQUIRE_FALSE(table.at("rows").empty());
  for (const auto& row : table.at("rows")) {
    const double roughness = TableNumber(row.at("roughness"));
    const double mu = TableNumber(row.at("mu"));
    CAPTURE(roughness, mu);
    const auto check = [&](Shadowing shadowing, const char* column) {
      const double want = TableNumber(row.at(column));
      CHECK(std::abs(AlbedoOfOne(shadowing, roughness, mu) - want) <= kTableTolerance);
      // The same through the azimuth's quadrature instead of its closed form.
      CHECK(std::abs(AlbedoOf(shadowing, roughness, mu, One) - want) <= kTableTolerance);
    };
    check(Shadowing::kHeightCorrelated, "E_corr");
    check(Shadowing::kSeparable, "E_sep");
    check(Shadowing::kSchlickDirect, "E_lessonG");
  }
}

TEST_CASE("averages and Schlick albedos are the table's", "[table]") {
  const nlohmann::json table = LoadTable("energy");
  for (const auto& row : table.at("average")) {
    const double roughness = TableNumber(row.at("roughness"));
    CAPTURE(roughness);
    const double e_average = AverageAlbedoOfOne(Shadowing::kHeightCorrelated, roughness);
    CHECK(std::abs(e_average - TableNumber(row.at("E_avg_corr"))) <= kTableTolerance);
    CHECK(std::abs(1 - e_average - TableNumber(row.at("loss_corr"))) <= kTableTolerance);
    CHECK(std::abs(AverageAlbedoOfOne(Shadowing::kSchlickDirect, roughness) -
                   TableNumber(row.at("E_avg_lessonG"))) <= kTableTolerance);
    for (const char* f0 : {"0.04", "0.5", "0.9", "1.0"}) {
      const double f_average = AverageSchlick(std::stod(f0));
      CHECK(std::abs(KullaContyFresnel(f_average, e_average) -
                     TableNumber(row.at(std::string("KullaConty_Fms_F0=") + f0))) <=
            kTableTolerance);
    }
  }
  REQUIRE_FALSE(table.at("dfg").empty());
  for (const auto& row : table.at("dfg")) {
    const double roughness = TableNumber(row.at("roughness"));
    const double mu = TableNumber(row.at("mu"));
    CAPTURE(roughness, mu);
    const auto check = [&](double got, const char* column) {
      CAPTURE(column);
      CHECK(std::abs(got - TableNumber(row.at(column))) <= kTableTolerance);
    };
    check(AlbedoOfOne(Shadowing::kHeightCorrelated, roughness, mu), "E");
    check(AlbedoOfSchlick(Shadowing::kHeightCorrelated, roughness, mu), "B");
    check(AlbedoOfOne(Shadowing::kSchlickDirect, roughness, mu), "E_lessonG");
    check(AlbedoOfSchlick(Shadowing::kSchlickDirect, roughness, mu), "B_lessonG");
  }
}

// int (r.v)^n n.v dv over the upper hemisphere for light at theta, in polar coordinates around r:
// whole circles up to where the cone around r meets the horizon, arcs from there.
double PhongIntegral(double shininess, double theta) {
  const Vec3d normal(0, 0, 1);
  const Vec3d to_light(-std::sin(theta), 0, std::cos(theta));
  const Vec3d r(std::sin(theta), 0, std::cos(theta));
  const Vec3d across(std::cos(theta), 0, -std::sin(theta));
  const QuadratureRule& rule = GaussLegendre(24);
  const auto ring = [&](double angle) {
    const double towards = -std::tan(M_PI_2 - angle) / std::tan(theta);  // cos of the arc's half
    const double end = theta > 0 && std::abs(towards) < 1 ? std::acos(towards) : M_PI;
    double sum = 0;
    for (size_t i = 0; i < rule.x.size(); ++i) {
      const double phi = end * rule.x[i];  // 0 where the ring is nearest the normal
      const Vec3d v = r * std::cos(angle) - across * (std::sin(angle) * std::cos(phi)) +
                      Vec3d(0, 1, 0) * (std::sin(angle) * std::sin(phi));
      sum += rule.w[i] * end * 2 * PhongLobe(normal, to_light, v, shininess) * (normal ^ v);
    }
    return sum * std::sin(angle);
  };
  const double meets = M_PI_2 - theta;
  double sum = meets * IntegrateTowardsZero([&](double x) { return ring(meets * x); }, 12);
  sum += theta * IntegrateTowardsZero([&](double x) { return ring(meets + theta * x); }, 16);
  return sum;
}

TEST_CASE("Phong reflectances are the table's, as printed", "[table]") {
  const nlohmann::json table = LoadTable("phong_albedo");
  const double kd = table.at("kd");
  const double ks = table.at("ks");
  // The table is good to 1e-11; the lobe's cosine is rounded, which shininess 1000 magnifies.
  const auto printed = [](const nlohmann::json& value) {
    return Approx(value.get<double>()).epsilon(1e-10).margin(0);
  };
  REQUIRE_FALSE(table.at("rows").empty());
  for (const auto& row : table.at("rows")) {
    const double shininess = row.at("n");
    const double theta = row.at("theta_deg").get<double>() * M_PI / 180;
    CAPTURE(shininess, theta);
    const double lobe = PhongIntegral(shininess, theta);
    CHECK(lobe == printed(row.at("P")));
    const double literal = M_PI * kd + ks * lobe / std::cos(theta);
    CHECK(literal == printed(row.at("literal_000")));
    CHECK(literal / M_PI == printed(row.at("pi_normalised")));
    const double modified = M_PI * kd + ks * lobe;
    CHECK(modified == printed(row.at("modified_004")));
    CHECK(modified / M_PI == printed(row.at("modified_pi")));
    CHECK(kd + ks * PhongNormalization(shininess) * lobe ==
          printed(row.at("normalised_lafortune")));
  }
}

TEST_CASE("albedos keep their closed forms and limits") {
  for (const double mu : {1e-6, 1e-3, 0.1, 0.5, 1.0}) {
    CAPTURE(mu);
    // Roughness 1: 1 - mu ln(1 + 1 / mu).
    CHECK(std::abs(AlbedoOfOne(Shadowing::kHeightCorrelated, 1, mu) -
                   (1 - mu * std::log1p(1 / mu))) < 1e-8);
    // A mirror, and what is all but one: alpha, the layer's width, is 1e-10.
    const double schlick = Power5(1 - mu);
    CHECK(AlbedoOfSchlick(Shadowing::kHeightCorrelated, 0, mu) == schlick);
    CHECK(std::abs(AlbedoOfSchlick(Shadowing::kSeparable, 1e-5, mu) - schlick) < 1e-6);
    const double k = 1.0 / 8;
    const double masked = mu / (mu * (1 - k) + k);
    CHECK(AlbedoOfOne(Shadowing::kSchlickDirect, 0, mu) == Approx(masked * masked));
    CHECK(AlbedoOfOne(Shadowing::kSchlickIbl, 0, mu) == 1);  // k is 0
  }
  CHECK(AverageAlbedoOfOne(Shadowing::kHeightCorrelated, 1) ==
        Approx(4.0 / 3 * (1 - std::log(2.0))).epsilon(1e-8));
}

}  // namespace
}  // namespace nacre
