// SPDX-License-Identifier: Apache-2.0
// tests/textbook/shading_table_test.cc: the lesson's functions in double against the tables, whose
// lesson_* columns are the lesson in exact arithmetic: clamps, floors and + 0.0001 included.
#include <cmath>

#include "catch.h"
#include "tables.h"
#include "textbook/conventions.h"
#include "textbook/shading.h"

namespace nacre {
namespace {

struct Row {
  TextbookPoint point;
  double shininess, roughness, f0;
  const nlohmann::json* ref;  // of the table
};

Vec3d UnitVec(const nlohmann::json& json) {
  return Vec3d(json[0].get<double>(), json[1].get<double>(), json[2].get<double>()).normalized();
}

// A column of the row; false where the table has none or no finite value.
bool Reference(const Row& row, const char* column, double* value) {
  const nlohmann::json json = row.ref->value(column, nlohmann::json());
  if (json.is_null() || json == "inf") return false;
  *value = TableNumber(json);
  return true;
}

int Check(const Row& row, const char* column, double got, double cond) {
  double reference = 0;
  if (!Reference(row, column, &reference)) return 0;
  CAPTURE(column, got, reference, cond);
  CHECK(PassesConditionedRule(got, reference, cond, kHalfUlpDouble));
  return 1;
}

// How much the roundings of a dot product that comes out as `cosine` weigh.
double CosineCond(double cosine) { return cosine > 0 ? 1 / cosine : 0; }

// d = n.h^2 (a^2 - 1) + 1 cancels near the peak; D is its square's inverse. The floor's D does not
// depend on it.
double DistributionCond(double n_dot_h, double roughness) {
  const double a2 = std::pow(roughness, 4);
  const double d = n_dot_h * n_dot_h * (a2 - 1) + 1;
  return M_PI * d * d <= 1e-10 ? 0 : 4 / d;
}

int CheckRow(const Row& row) {
  const TextbookFaults lesson;
  const TextbookPoint& p = row.point;
  int checked = 0;
  double rv = 0;
  if (Reference(row, "rv", &rv)) {
    checked += Check(row, "phong_ungated", TextbookPhongLobe(p, row.shininess),
                     4 * row.shininess * CosineCond(rv));
  }
  double nh = 0;
  double vh = 0;
  if (!Reference(row, "nh", &nh) || !Reference(row, "vh", &vh)) return checked;
  // H = L + V: its roundings grow as it shrinks, |L + V| = 2 v.h.
  const double half_cond = CosineCond(vh);
  checked += Check(row, "blinn_ungated", TextbookBlinnLobe(p, row.shininess, lesson),
                   4 * row.shininess * CosineCond(nh) * (1 + half_cond));
  const TextbookAngles a = TextbookAnglesAt(p, lesson);
  const double grazing = CosineCond(a.n_dot_l) + CosineCond(a.n_dot_v);
  const double peak = DistributionCond(nh, row.roughness) * (1 + half_cond);
  const double fresnel = 5 * (1 + half_cond) / row.f0;
  checked += Check(row, "lesson_D", TextbookDistribution(a, row.roughness, lesson), peak);
  checked += Check(row, "lesson_F", TextbookFresnel(a.v_dot_h, row.f0), fresnel);
  checked += Check(row, "lesson_G", TextbookGeometry(a.n_dot_v, a.n_dot_l, row.roughness, lesson),
                   grazing);
  checked += Check(row, "lesson_spec_verbatim", TextbookSpecular(a, row.roughness, row.f0, lesson),
                   peak + fresnel + 2 * grazing);
  return checked;
}

TEST_CASE("the lesson's terms are the tables' on the hard rows", "[table]") {
  int checked = 0;
  const nlohmann::json table = LoadTable("brdf_hard");
  for (const auto& json : table.at("rows")) {
    CAPTURE(json.at("id").get<std::string>());
    Row row;
    row.point.normal = UnitVec(json.at("n"));
    row.point.to_light = UnitVec(json.at("l"));
    row.point.to_view = UnitVec(json.at("v"));
    row.shininess = json.at("exponent").get<double>();
    row.roughness = json.at("roughness").get<double>();
    row.f0 = json.at("f0").get<double>();
    row.ref = &json.at("ref");
    checked += CheckRow(row);
  }
  CHECK(checked > 0);
}

TEST_CASE("the lesson's encoding is the table's", "[table]") {
  const nlohmann::json table = LoadTable("tonemap");
  REQUIRE_FALSE(table.at("scalar").empty());
  for (const auto& row : table.at("scalar")) {
    const double x = TableNumber(row.at("x"));
    const double got = TextbookEncode(x, TextbookFaults());
    CAPTURE(x, got);
    // The tables' rule: 16 half-ulps.
    const double reference = TableNumber(row.at("lesson_pbr_encode"));
    CHECK(std::abs(got - reference) <= 16 * kHalfUlpDouble * reference);
    // From 2^53 on, double rounds x / (x + 1) to 1, in the lesson's program as here; the table's
    // exact value stays below, and is truncated to 254.
    const int code = x < 0x1p53 ? row.at("lesson_uint8_trunc").get<int>() : 255;
    CHECK(static_cast<int>(got * 255) == code);
  }
}

TEST_CASE("gamma 2.2 is as far from sRGB as the table says", "[table]") {
  const nlohmann::json facts = LoadTable("tonemap_facts");
  const GammaError error = LargestGammaError();
  // The maximum is flat: a step of 1e-5 around it changes 1e-6 of it.
  CHECK(error.difference ==
        Approx(TableNumber(facts.at("max_abs_gamma22_vs_srgb_encoded"))).epsilon(1e-5));
  CHECK(std::abs(error.at_linear - TableNumber(facts.at("at_linear"))) < 2e-5);
}

}  // namespace
}  // namespace nacre
