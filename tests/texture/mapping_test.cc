// SPDX-License-Identifier: Apache-2.0
// tests/texture/mapping_test.cc: mappings against tables/mappings.json, their gradients against
// finite differences, and the SIMD twins against the scalar ones.
#include "texture/mapping.h"

#include <cmath>
#include <random>

#include "catch.h"
#include "tables.h"
#include "targets.h"
#include "texture/mapping_kernel.h"

namespace nacre {
namespace {

constexpr MappingKind kKinds[] = {MappingKind::kSpherical, MappingKind::kCylindrical,
                                  MappingKind::kPlanar, MappingKind::kCube};

Mapped<double> Map(MappingKind kind, const Vec3d& p) {
  switch (kind) {
    case MappingKind::kCylindrical:
      return MapCylindrical(p);
    case MappingKind::kPlanar:
      return MapPlanar(p);
    case MappingKind::kCube:
      return MapCube(p);
    default:
      return MapSpherical(p);
  }
}

std::vector<Vec3d> RandomPoints(size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> component(-1, 1);
  std::vector<Vec3d> points(count);
  for (Vec3d& p : points) p = Vec3d{component(random), component(random), component(random)};
  return points;
}

TEST_CASE("mappings match the table", "[table]") {
  const nlohmann::json table = LoadTable("mappings");
  REQUIRE(table.at("rows").size() > 0);
  for (const auto& row : table.at("rows")) {
    const Vec3d p(row["d"][0].get<double>(), row["d"][1].get<double>(), row["d"][2].get<double>());
    CAPTURE(p.x, p.y, p.z);
    // 1e-6 is the table's rule.
    const auto close = [&](double got, const char* key) {
      return std::abs(got - TableNumber(row[key])) <= 1e-6;
    };
    const auto spherical = MapSpherical(p);
    CHECK(close(spherical.u, "spherical_u"));
    CHECK(close(spherical.v, "spherical_v"));
    CHECK(close(MapCylindrical(p).u, "cyl_u"));
    CHECK(CubeFace(p) == row["cube_face"].get<int>());
    CHECK(close(MapCube(p).u, "cube_s"));
    CHECK(close(MapCube(p).v, "cube_t"));
    ForEachTarget([&](Target) {
      const auto at = [&](MappingKind kind) { return MapPoints(kind, {p})[0]; };
      CHECK(close(at(MappingKind::kSpherical).u, "spherical_u"));
      CHECK(close(at(MappingKind::kSpherical).v, "spherical_v"));
      CHECK(close(at(MappingKind::kCylindrical).u, "cyl_u"));
      CHECK(close(at(MappingKind::kCube).u, "cube_s"));
      CHECK(close(at(MappingKind::kCube).v, "cube_t"));
    });
  }
}

// Longitudes are periodic.
double Turned(double difference) { return difference - std::round(difference); }

TEST_CASE("gradients are those of the mapping") {
  const double step = 1e-6;
  for (const MappingKind kind : kKinds) {
    for (const Vec3d& p : RandomPoints(200)) {
      if (p.x * p.x + p.y * p.y < 0.01) continue;  // differences are poor where gradients are large
      const Mapped<double> at = Map(kind, p);
      for (int axis = 0; axis < 3; ++axis) {
        Vec3d before = p, after = p;
        before[axis] -= step;
        after[axis] += step;
        if (kind == MappingKind::kCube && CubeFace(before) != CubeFace(after)) continue;
        const Mapped<double> a = Map(kind, before), b = Map(kind, after);
        // Central differences: step^2 times third derivatives of up to 1e3 or so, and rounding of
        // 1e-16 / step.
        CHECK(at.du[axis] == Approx(Turned(b.u - a.u) / (2 * step)).margin(1e-7).epsilon(1e-7));
        CHECK(at.dv[axis] == Approx((b.v - a.v) / (2 * step)).margin(1e-7).epsilon(1e-7));
      }
    }
  }
}

TEST_CASE("gradients are the same on both sides of the seam") {
  const Mapped<double> above = MapSpherical(Vec3d(0.8, 1e-12, 0.6));
  const Mapped<double> below = MapSpherical(Vec3d(0.8, -1e-12, 0.6));
  CHECK(above.u == Approx(0).margin(1e-12));
  CHECK(below.u == Approx(1));
  CHECK((above.du - below.du).length() < 1e-11);
  CHECK((above.dv - below.dv).length() < 1e-11);
}

TEST_CASE("the mappings' twins agree") {
  std::vector<Vec3d> points = RandomPoints(500);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Vec3d pole(0);
      pole[axis] = sign;
      points.push_back(pole);
      points.push_back(pole + Vec3d(1e-9));  // next to a pole
    }
  }
  points.emplace_back(0, 0, 0);
  points.emplace_back(0.5, -0.0, 0.1);
  ForEachTarget([&](Target) {
    for (const MappingKind kind : kKinds) {
      const std::vector<Mapped<double>> got = MapPoints(kind, points);
      for (size_t i = 0; i < points.size(); ++i) {
        CAPTURE(static_cast<int>(kind), points[i].x, points[i].y, points[i].z);
        const Mapped<double> expected = Map(kind, points[i]);
        // A few roundings each; angles by Highway are within 3 ulp.
        CHECK(std::abs(got[i].u - expected.u) <= 1e-15);
        CHECK(std::abs(got[i].v - expected.v) <= 1e-15);
        CHECK((got[i].du - expected.du).length() <= 1e-14 * (1 + expected.du.length()));
        CHECK((got[i].dv - expected.dv).length() <= 1e-14 * (1 + expected.dv.length()));
      }
    }
  });
}

}  // namespace
}  // namespace nacre
