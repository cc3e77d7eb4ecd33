// SPDX-License-Identifier: Apache-2.0
// tests/brdf/fresnel_test.cc: Fresnel curves and their averages against the tables and their
// limits.
#include "brdf/fresnel.h"

#include <cmath>
#include <map>

#include "brdf/energy_kernel.h"
#include "brdf/presets.h"
#include "catch.h"
#include "tables.h"
#include "targets.h"

namespace nacre {
namespace {

// The table's pass rule for Fresnel values.
constexpr double kTableTolerance = 1e-6;

struct Row {
  std::string material;
  bool conductor;
  double eta, k, cos, f0, exact, schlick;
  bool has_f82;
  double f82;
};

std::vector<Row> LoadRows() {
  std::vector<Row> rows;
  const nlohmann::json table = LoadTable("fresnel");
  for (const auto& json : table.at("rows")) {
    Row row{};
    row.material = json.at("material");
    row.conductor = json.at("type") == "conductor";
    if (row.conductor) {
      row.eta = TableNumber(json.at("n"));
      row.k = TableNumber(json.at("k"));
    } else if (json.at("eta").is_null()) {  // 1 / 1.5, as a fraction
      row.eta = TableNumber(json.at("num")) / TableNumber(json.at("den"));
    } else {
      row.eta = TableNumber(json.at("eta"));
    }
    row.cos = TableNumber(json.at("cos"));
    row.f0 = TableNumber(json.at("F0"));
    row.exact = TableNumber(json.at("exact"));
    row.schlick = TableNumber(json.at("schlick"));
    row.has_f82 = !json.at("f82").is_null();
    if (row.has_f82) row.f82 = TableNumber(json.at("f82"));
    rows.push_back(row);
  }
  REQUIRE_FALSE(rows.empty());
  return rows;
}

double Exact(const Row& row, double cos) {
  return row.conductor ? FresnelConductor(cos, 1 - cos, row.eta, row.k)
                       : FresnelDielectric(cos, 1 - cos, row.eta);
}

// F82's second point is the exact curve's own, at cos = 1/7.
double Slope(const Row& row) { return F82Slope(row.f0, Exact(row, 1.0 / 7)); }

void CheckRow(const Row& row, const FresnelOutput& got) {
  CAPTURE(row.material, row.cos);
  CHECK(std::abs((row.conductor ? got.conductor : got.dielectric) - row.exact) <= kTableTolerance);
  CHECK(std::abs(got.schlick - row.schlick) <= kTableTolerance);
  if (row.has_f82) CHECK(std::abs(got.f82 - row.f82) <= kTableTolerance);
}

TEST_CASE("Fresnel curves in double are the table's", "[table]") {
  // Nothing cancels, so the printed 30 digits are met to rounding, of which there are about 20.
  constexpr double kRounding = 20 * 0x1p-52;
  for (const Row& row : LoadRows()) {
    CAPTURE(row.material, row.cos);
    CHECK(std::abs(Exact(row, row.cos) - row.exact) <= kRounding);
    CHECK(std::abs(FresnelSchlick(row.f0, Power5(1 - row.cos)) - row.schlick) <= kRounding);
    if (!row.has_f82) continue;
    // Fitting the slope divides by 6/49 (6/7)^5 = 0.057, which magnifies rounding.
    CHECK(std::abs(FresnelF82(row.cos, 1 - row.cos, row.f0, Slope(row)) - row.f82) <=
          20 * kRounding);
  }
}

TEST_CASE("SIMD Fresnel curves are the table's on every target", "[table]") {
  const std::vector<Row> rows = LoadRows();
  std::vector<FresnelInput> inputs;
  inputs.reserve(rows.size());
  for (const Row& row : rows) {
    inputs.push_back({static_cast<float>(row.cos), static_cast<float>(1 - row.cos),
                      static_cast<float>(row.eta), static_cast<float>(row.k),
                      static_cast<float>(row.f0), static_cast<float>(Slope(row))});
  }
  ForEachTarget([&](Target) {
    const std::vector<FresnelOutput> outputs = EvaluateFresnel(inputs);
    for (size_t i = 0; i < rows.size(); ++i) CheckRow(rows[i], outputs[i]);
  });
}

TEST_CASE("Fresnel averages, F0 and tints are the summary's", "[table]") {
  std::map<std::string, Row> materials;
  for (const Row& row : LoadRows()) materials.emplace(row.material, row);
  const nlohmann::json summary = LoadTable("fresnel_summary");
  size_t known = 0;
  // Printed to 15 significant digits.
  const auto printed = [](double value) { return Approx(value).epsilon(1e-13).margin(0); };
  for (const auto& [name, want] : summary.items()) {
    CAPTURE(name);
    if (!materials.contains(name)) continue;  // the curves may be of another table
    ++known;
    const Row& row = materials.at(name);
    CHECK(FresnelF0(row.eta, row.k) == printed(TableNumber(want.at("F0"))));
    CHECK(AverageSchlick(row.f0) == printed(TableNumber(want.at("Favg_schlick"))));
    const double average =
        row.conductor ? AverageConductor(row.eta, row.k) : AverageDielectric(row.eta);
    CHECK(average == printed(TableNumber(want.at("Favg_exact_cosine_weighted"))));
    const double at_82 = FresnelSchlick(row.f0, Power5(6.0 / 7));
    const double tint = TableNumber(want.at("F82_tint"));
    CHECK(Exact(row, 1.0 / 7) / at_82 == printed(tint));
    // Either way to the slope; the printed tint's last digit is magnified by 1 / 0.057.
    CHECK(F82SlopeFromTint(row.f0, tint) == Approx(Slope(row)).margin(1e-12));
    // How far the fits are from the exact curve at most: printed to 8 digits, found on a grid, and
    // nowhere more.
    const auto check_distance = [&](const char* largest, const char* at, const auto& curve) {
      CAPTURE(largest);
      const auto distance = [&](double cos) { return std::abs(curve(cos) - Exact(row, cos)); };
      const double most = TableNumber(want.at(largest));
      CHECK(distance(TableNumber(want.at(at))) == Approx(most).epsilon(1e-7));
      // Between the grid's points, 5e-4 apart, the distance is a little more than on them.
      for (int i = 0; i <= 2000; ++i) CHECK(distance(i / 2000.0) <= most + 1e-6);
    };
    check_distance("max_abs_schlick_minus_exact", "at_cos",
                   [&](double cos) { return FresnelSchlick(row.f0, Power5(1 - cos)); });
    if (!row.conductor) continue;
    check_distance("max_abs_f82_minus_exact", "at_cos_f82",
                   [&](double cos) { return FresnelF82(cos, 1 - cos, row.f0, Slope(row)); });
  }
  CHECK(known > 0);
}

TEST_CASE("F82 averages to its closed form") {
  for (const double tint : {1.0, 0.9, 0.7}) {
    const double f0 = 0.6;
    const double slope = F82SlopeFromTint(f0, tint);
    CHECK(FresnelF82(1.0 / 7, 6.0 / 7, f0, slope) ==
          Approx(tint * (f0 + (1 - f0) * std::pow(6.0 / 7, 5))).epsilon(1e-14));
    constexpr int kSteps = 20000;  // the midpoint rule is off by f'' / 24 kSteps^2: under 1e-8
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double c = (i + 0.5) / kSteps;
      sum += 2 * c * FresnelF82(c, 1 - c, f0, slope) / kSteps;
    }
    CHECK(AverageF82(f0, slope) == Approx(sum).margin(1e-8));
  }
}

TEST_CASE("Fresnel limits are exact, and nothing leaves [0, 1]") {
  for (const double eta : {1.0001, 1.333, 2.4, 50.0}) {
    CHECK(FresnelDielectric(1.0, 0.0, eta) == Approx(FresnelF0(eta, 0.0)).epsilon(1e-13));
    CHECK(FresnelDielectric(0.0, 1.0, eta) == Approx(1).epsilon(1e-12));
    CHECK(FresnelDielectric(0.3, 0.7, 1 / eta) <= 1);
    // A conductor that absorbs nothing is a dielectric.
    for (const double c : {0.01, 0.3, 0.9}) {
      CHECK(FresnelConductor(c, 1 - c, eta, 0.0) ==
            Approx(FresnelDielectric(c, 1 - c, eta)).epsilon(1e-10));
    }
  }
  CHECK(FresnelDielectric(0.7, 0.3, 1 / 1.5) == 1);  // beyond the critical angle, 0.745
  CHECK(FresnelDielectric(0.75, 0.25, 1 / 1.5) < 1);
  CHECK(FresnelF82(0.5, 0.5, 0.0, F82SlopeFromTint(0.04, 0.0)) == 0);  // held, not negative
  ForEachTarget([](Target) {
    std::vector<FresnelInput> inputs;
    for (const float c : {0.0f, 1e-20f, 1e-6f, 0.1f, 0.5f, 1 - 0x1p-24f, 1.0f}) {
      for (const float eta : {1e-3f, 0.5f, 1.0f, 1.0001f, 1.5f, 1e3f}) {
        for (const float k : {0.0f, 1e-6f, 1.0f, 1e3f}) {
          inputs.push_back({c, 1 - c, eta, k, 0.04f, F82SlopeFromTint(0.04f, 0.0f)});
        }
      }
    }
    const float top = 1 + 8 * 0x1p-23f;  // roundings of a value of 1
    const std::vector<FresnelOutput> outputs = EvaluateFresnel(inputs);
    for (size_t i = 0; i < inputs.size(); ++i) {
      const FresnelOutput& out = outputs[i];
      CAPTURE(inputs[i].v_dot_h, inputs[i].eta, inputs[i].k, out.dielectric, out.conductor);
      CHECK((out.dielectric >= 0 && out.dielectric <= top));
      CHECK((out.conductor >= 0 && out.conductor <= top));
      CHECK((out.f82 >= 0 && out.f82 <= 1));
    }
  });
}

TEST_CASE("named indices are found, and metals have their colours") {
  CHECK(FindIndexPreset("brass") == nullptr);
  REQUIRE(IndexPresets().size() == 8);
  for (const IndexPreset& preset : IndexPresets()) {
    CHECK(FindIndexPreset(preset.name) == &preset);
    for (size_t c = 0; c < 3; ++c) {
      CHECK((preset.k[c] > 0) == (preset.kind == InterfaceKind::kConductor));
    }
  }
  const auto f0 = [](const char* name, size_t c) {
    const IndexPreset& preset = *FindIndexPreset(name);
    return FresnelF0(preset.eta[c], preset.k[c]);
  };
  for (const char* name : {"gold", "copper"}) {  // red > green > blue
    CHECK(f0(name, 0) > f0(name, 1));
    CHECK(f0(name, 1) > f0(name, 2));
  }
  CHECK(f0("silver", 1) > 0.9);
  CHECK(f0("glass", 0) == Approx(kDielectricF0));
}

}  // namespace
}  // namespace nacre
