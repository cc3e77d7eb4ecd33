// SPDX-License-Identifier: Apache-2.0
// Newell's normals against polygons of 1e-6 to 1e6, at the origin and far from it.
#include <cmath>
#include <vector>

#include "catch.h"
#include "scene/polygon.h"
#include "tables.h"

namespace nacre {
namespace {

TEST_CASE("Newell's normal keeps its direction at any size and place", "[table]") {
  const nlohmann::json table = LoadTable("polygon_normals");
  for (const nlohmann::json& row : table.at("rows")) {
    CAPTURE(row.dump());
    std::vector<Vec3d> corners;
    for (const nlohmann::json& v : row.at("vertices")) {
      corners.emplace_back(v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
    }
    const Vec3d expected(TableNumber(row.at("unit_normal")[0]),
                         TableNumber(row.at("unit_normal")[1]),
                         TableNumber(row.at("unit_normal")[2]));
    const Vec3d normal = NewellNormal(corners);
    const double size = row.at("scale").get<double>();
    const double far = std::abs(row.at("translation").get<double>()) / size;
    // 8 u (1 + translation / size), the tables' rule, with the u of double: differences of nearby
    // coordinates are exact, so the distance does not even matter here.
    const double bound = 8 * kHalfUlpDouble * (1 + far);
    for (int c = 0; c < 3; ++c) CHECK(std::abs(normal.normalized()[c] - expected[c]) <= bound);
    const double length = TableNumber(row.at("newell_length"));
    CHECK(std::abs(normal.length() - length) <= 16 * kHalfUlpDouble * (1 + far) * length);
  }
}

}  // namespace
}  // namespace nacre
