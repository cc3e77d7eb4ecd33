// SPDX-License-Identifier: Apache-2.0
// tests/visibility/ray_sphere_test.cc: the ray-sphere test against exact references.
#include <cmath>

#include "catch.h"
#include "tables.h"
#include "targets.h"
#include "visibility/quad_hits.h"
#include "visibility/rays.h"

namespace nacre {
namespace {

struct TableRow {
  std::string id, family;
  Ray ray;
  TraceSphere sphere;
  nlohmann::json reference;
};

std::vector<TableRow> LoadRows() {
  const nlohmann::json table = LoadTable("ray_sphere");
  std::vector<TableRow> rows;
  for (const auto& row : table["rows"]) {
    rows.push_back({row["id"],
                    row["family"],
                    {TableVector(row["o"]), TableVector(row["d"])},
                    {TableVector(row["c"]), row["r"].get<double>()},
                    row["ref"]});
  }
  return rows;
}

// Whether the ray hits, and where, by the table's rule for double.
void CheckRow(const TableRow& row, const Hit& hit) {
  INFO(row.id << " " << row.family << ": t = " << hit.t);
  const bool hits = hit.primitive != kNoPrimitive;
  const auto& reference = row.reference;
  const bool expected =
      reference["line_hit"].get<bool>() && reference.contains("t") && reference["t"].is_string();
  REQUIRE(hits == expected);
  if (!hits) return;
  if (reference["cond_t"].is_null()) {
    CHECK((std::isfinite(hit.t) && hit.t >= 0));
    return;
  }
  CHECK(PassesConditionedRule(hit.t, TableNumber(reference["t"]), TableNumber(reference["cond_t"]),
                              kHalfUlpDouble));
}

// Both roots, and the hit point. The inputs are exact in double, so that all errors are nacre's own
// roundings: those of the discriminant, a few of radius^2 |direction|^2, are divided by the cosine
// of incidence, whose square the discriminant is. 64 of them are allowed, and as many of the
// others.
void CheckPoint(const TableRow& row, const SphereHit<double>& hit) {
  INFO(row.id << " " << row.family);
  const auto& reference = row.reference;
  if (!hit.hit || reference["cond_t"].is_null()) return;
  const Vec3d& direction = row.ray.direction;
  const double cond = TableNumber(reference["cond_t"]);
  const double half_chord = hit.root / direction.length2();
  const double discriminant = TableNumber(reference["disc4"]);
  const double scale = direction.length2() * row.sphere.radius * row.sphere.radius;
  CHECK(std::abs(hit.root * hit.root - discriminant) <= 64 * kHalfUlpDouble * scale);
  // The root farther from the origin, which does not cancel.
  const bool ahead = hit.closest > 0;
  const double far = ahead ? hit.closest + half_chord : hit.closest - half_chord;
  const double far_reference = TableNumber(reference[ahead ? "t1" : "t0"]);
  CHECK(PassesConditionedRule(std::abs(far), std::abs(far_reference), cond, kHalfUlpDouble));
  const double cosine = TableNumber(reference["cos_incidence"]);
  const double tolerance = 64 * kHalfUlpDouble * (1 + 1 / std::abs(cosine));
  const Vec3d normal = CenterToHit(hit, direction) / row.sphere.radius;
  const Vec3d point = row.sphere.center + normal * row.sphere.radius;
  for (int c = 0; c < 3; ++c) {
    const auto axis = static_cast<size_t>(c);
    CHECK(std::abs(normal[c] - TableNumber(reference["n"][axis])) <= tolerance);
    CHECK(std::abs(point[c] - TableNumber(reference["p"][axis])) <=
          tolerance * row.sphere.radius + 8 * kHalfUlpDouble * std::abs(row.sphere.center[c]));
  }
  // The table prints it to 12 digits.
  CHECK(std::abs(-(normal ^ direction) / direction.length() - cosine) <= tolerance + 1e-11);
}

// A ray from the origin and a sphere of radius 1 at this distance, whose centre it misses by
// offset.
Ray RayPast(Random* random, const Vec3d& center, double offset) {
  const Vec3d across = center.cross(random->Direction()).normalized();
  const double distance = center.length();
  // The foot of the perpendicular lies at `offset` from the centre.
  const double sine = offset / distance;
  const Vec3d foot = center * (1 - sine * sine) + across * (offset * std::sqrt(1 - sine * sine));
  return {Vec3d(0), foot * random->Magnitude(0.5, 2) / distance};
}

TEST_CASE("the scalar ray-sphere test passes the table", "[table]") {
  for (const TableRow& row : LoadRows()) {
    const auto hit =
        TestSphere(row.sphere.center - row.ray.origin, row.ray.direction, row.sphere.radius);
    CheckRow(row, hit.hit ? Hit{0, hit.t} : Hit{});
    CheckPoint(row, hit);
  }
}

TEST_CASE("the intersector passes the table, with the scalar test's bits", "[table]") {
  const std::vector<TableRow> rows = LoadRows();
  ForEachTarget([&](Target) {
    for (const TableRow& row : rows) {
      if (row.sphere.radius <= 0 || row.family == "denormal") continue;  // no scene has these
      Scene scene;
      scene.spheres.push_back(MakeSphere(row.sphere.center, row.sphere.radius));
      const Hit hit = Trace(Intersector(scene, Vec3d(0)), {row.ray}).front();
      CheckRow(row, hit);
      CHECK(hit == BruteForce(MakeTraceGeometry(scene, Vec3d(0)), row.ray));
    }
  });
}

// The normal's error comes from a few roundings of radius^2 |direction|^2 - |moment|^2: the worst
// that was found is 8 u, whose square root, 3e-8, is the error for grazing rays.
TEST_CASE("hits are right at any distance, grazing ones too") {
  const Products products = GENERATE(Products::kFused, Products::kRounded);
  constexpr double kMaxNormalError = 3e-8;
  constexpr double kMaxDepthError = 1e-15 * 8;  // 64 roundings
  // Of rays that meet the sphere steeply: 16 roundings.
  constexpr double kMaxSteepError = 16 * kHalfUlpDouble;
  Random random(1);
  for (const double distance : {2.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7}) {
    double worst_normal = 0, worst_depth = 0, worst_steep = 0;
    int wrong = 0;
    for (int i = 0; i < 60000; ++i) {
      const TraceSphere sphere{random.Direction() * distance, 1};
      const bool grazing = i % 3 != 0;
      const double side = i % 2 == 0 ? 1 : -1;
      const double offset =
          grazing ? 1 + side * random.Magnitude(1e-12, 1e-2) : random.Uniform(0, 1.2);
      const Ray ray = RayPast(&random, sphere.center, offset);
      const QuadHit expected = TestInQuad(ray.origin, ray.direction, sphere);
      const auto hit = TestSphere(sphere.center, ray.direction, sphere.radius, products);
      wrong += hit.hit != expected.hit;
      if (!hit.hit || !expected.hit) continue;
      const Vec3d normal = CenterToHit(hit, ray.direction, products) / sphere.radius;
      const double error = AngleTo(expected.normal, normal);
      worst_normal = std::max(worst_normal, error);
      if (offset < 0.7) worst_steep = std::max(worst_steep, error);
      worst_depth = std::max(worst_depth, std::abs(hit.t - expected.t) / expected.t);
    }
    INFO("products " << static_cast<int>(products) << " distance " << distance << " normal "
                     << worst_normal << " depth " << worst_depth);
    CHECK(wrong == 0);
    CHECK(worst_normal <= kMaxNormalError);
    CAPTURE(worst_steep);
    CHECK(worst_steep <= kMaxSteepError);
    // Where the chord is short its own error, relative to the radius, shows in the depth.
    CHECK(worst_depth <= kMaxDepthError + kMaxNormalError / distance);
  }
}

// A chord of 2 h seen from just above: the depth's error is that of |c|^2 - r^2, 2 u r / height.
TEST_CASE("the ground sphere under the eye is right") {
  Random random(2);
  Scene scene;
  scene.spheres.push_back(MakeSphere(Vec3d(0), 1e6));
  for (const double height : {1.0, 2.5, 10.0}) {
    const Vec3d eye(0, 1e6 + height, 0);
    const Intersector intersector(scene, eye);
    std::vector<Ray> rays(20000);
    for (Ray& ray : rays) {
      ray.direction = random.Direction() + Vec3d(0, random.Uniform(-0.5, 0.1), 0);
    }
    const std::vector<Hit> hits = Trace(intersector, rays);
    double worst = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      const QuadHit expected = TestInQuad(rays[i].origin, rays[i].direction, {-eye, 1e6});
      REQUIRE((hits[i].primitive == 0) == expected.hit);
      if (expected.hit) worst = std::max(worst, std::abs(hits[i].t - expected.t) / expected.t);
    }
    INFO("height " << height << " worst " << worst);
    CHECK(worst > 0);
    CHECK(worst <= 1e-9);
  }
}

TEST_CASE("refined hits are the scalar test's, on every target") {
  Random random(3);
  Scene scene = RandomSpheres(&random, 60);
  scene.spheres.push_back(MakeSphere({0, 0, 0}, 30));  // around the camera
  const TraceGeometry geometry = MakeTraceGeometry(scene, Vec3d(0));
  const std::vector<Ray> rays = CameraRays(&random, 3000);
  ForEachTarget([&](Target) {
    const Intersector intersector(scene, Vec3d(0));
    const std::vector<HitSurface> surfaces = TraceSurfaces(intersector, rays);
    REQUIRE(surfaces.size() == rays.size());
    for (size_t i = 0; i < rays.size(); ++i) {
      const HitSurface& surface = surfaces[i];
      const auto& [center, radius] = geometry.spheres[surface.primitive];
      const Vec3d& direction = rays[i].direction;
      const auto hit = TestSphere(center, direction, radius, TargetProducts());
      const Vec3d to_hit = ScaledCenterToHit(hit, direction, TargetProducts());
      const double dd = Dot(direction, direction, TargetProducts());
      const double signed_radius = hit.inside ? -radius : radius;
      REQUIRE(hit.hit);
      REQUIRE(surface.normal == to_hit * (1 / (dd * signed_radius)));
      for (int c = 0; c < 3; ++c) {
        REQUIRE(surface.position[c] ==
                MulAdd(surface.normal[c], signed_radius, center[c], TargetProducts()));
      }
      REQUIRE(surface.normal.dot(direction) <= 0);
      REQUIRE(std::abs(surface.normal.length() - 1) < 8 * kHalfUlpDouble);
      REQUIRE((surface.to_view + direction.normalized()).length() < 8 * kHalfUlpDouble);
    }
  });
}

}  // namespace
}  // namespace nacre
