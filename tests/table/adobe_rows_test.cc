// SPDX-License-Identifier: Apache-2.0
// tests/table/adobe_rows_test.cc: rules "adobe" against values of adobe/openpbr-bsdf, lobe by lobe.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "catch.h"
#include "scene/material_parameters.h"
#include "table/brdf_table.h"
#include "tables.h"

namespace nacre {
namespace {

Vec3d ToVector(const nlohmann::json& xyz) { return {xyz[0], xyz[1], xyz[2]}; }

Material AdobeMaterial(const nlohmann::json& parameters) {
  const MaterialModel& model = *FindModel("open_pbr");
  Material material = model.make();
  auto& open_pbr = std::get<OpenPbrMaterial>(material.model);
  open_pbr.options = OptionsOf(OpenPbrRules::kAdobe);
  // The rows hold lobes without what compensation adds, for which the library has tables of its
  // own.
  open_pbr.options.compensation = Compensation::kNone;
  for (const auto& [name, value] : parameters.items()) {
    const MaterialParameter* const parameter = FindParameter(model, name);
    REQUIRE(parameter != nullptr);
    parameter->set(material, value.is_array() ? Rgb(ToVector(value)) : Rgb(value.get<double>()));
  }
  return material;
}

// The largest error of a row's part, relative to its brightest channel.
double ErrorOfRow(const nlohmann::json& row) {
  const Vec3d view = ToVector(row[1]).normalized(), light = ToVector(row[2]).normalized();
  const std::vector<DirectionPair> pairs = {{light, view}};
  const BrdfTable table = TabulateBrdf(AdobeMaterial(row[0]), pairs, {.albedo = false});
  const std::string first = row[3].get<std::string>() + "_r";
  const auto column = std::ranges::find(table.columns, first);
  REQUIRE(column != table.columns.end());
  const Vec3d want = ToVector(row[4]);
  double error = 0;
  for (size_t c = 0; c < 3; ++c) {
    const auto at = static_cast<size_t>(column - table.columns.begin()) + c;
    error = std::max(error, std::abs(table.At(0, at) * light.z - want[static_cast<int>(c)]));
  }
  // Of fuzz, less than this is seen of nothing.
  const double least = row[3] == "fuzz" ? 0.005 : 0;
  return error / std::max({want.x, want.y, want.z, least});
}

}  // namespace

TEST_CASE("rules adobe are Adobe's library, lobe by lobe", "[table]") {
  std::map<std::string, size_t> counts;
  const nlohmann::json table = LoadTable("openpbr_adobe");
  for (const nlohmann::json& row : table["rows"]) {
    const std::string part = row[3];
    const auto has = [&](const char* weight) { return row[0].value(weight, 0.0) > 0; };
    const bool is_covered = has("coat_weight") || has("fuzz_weight");
    // What covers a lobe, and what a diffuse base is left, is by tables of 16 bits there. Their
    // fuzz is a table of 32 by 32, looked up linearly: a grazing row differs by a tenth.
    const double bound = part == "fuzz" ? 0.1 : part == "diffuse" || is_covered ? 1e-2 : 1e-4;
    INFO(row.dump());
    CHECK(ErrorOfRow(row) <= bound);
    ++counts[part];
  }
  CHECK(counts["specular"] > 60);
  CHECK(counts["diffuse"] > 40);
  CHECK(counts["coat"] > 15);
  CHECK(counts["fuzz"] > 10);
}

}  // namespace nacre
