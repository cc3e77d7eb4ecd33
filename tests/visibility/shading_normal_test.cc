// SPDX-License-Identifier: Apache-2.0
// Shading normals bent to where reflection models can use them.
#include "hit/shading_normal.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "brdf/angles.h"
#include "catch.h"
#include "targets.h"
#include "visibility/bend_kernel.h"

namespace nacre {
namespace {

Vec3d RandomUnit(std::mt19937* random) {
  std::normal_distribution<double> normal;
  return Vec3d(normal(*random), normal(*random), normal(*random)).normalized();
}

Vec3d OnSideOf(const Vec3d& v, const Vec3d& side) { return v.dot(side) < 0 ? -v : v; }

// Random shading normals and view directions above the surface; half of the view directions are
// grazing.
std::vector<BendQuery> Queries() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<BendQuery> queries;
  for (int i = 0; i < 20000; ++i) {
    BendQuery q;
    q.surface = RandomUnit(&random);
    q.normal = OnSideOf(RandomUnit(&random), q.surface);
    q.to_view = OnSideOf(RandomUnit(&random), q.surface);
    if (i % 2 == 0) {
      const Vec3d along = (q.to_view - q.surface * q.surface.dot(q.to_view)).normalized();
      const double height = std::pow(10, -7 * unit(random));
      q.to_view = along * std::sqrt(1 - height * height) + q.surface * height;
    }
    queries.push_back(q);
  }
  return queries;
}

TEST_CASE("a shading normal faces its viewer, and its mirror direction leaves the surface") {
  size_t kept = 0, bent = 0;
  for (const BendQuery& q : Queries()) {
    const Vec3d n = BendNormal(q.normal, q.surface, q.to_view);
    CHECK(std::abs(n.length() - 1) <= 1e-15);
    // Roundings of unit vectors.
    CHECK(n.dot(q.to_view) >= -1e-15);
    CHECK(n.dot(q.surface) >= -1e-15);
    // The half vector of directions along the surface, one of them 1e-7 above it, may be as short
    // as that: the same rounding errors divided by 1e-7.
    CHECK(Mirrored(q.to_view, n).dot(q.surface) >= -1e-8);
    const bool was_usable =
        q.normal.dot(q.to_view) >= 0 && Mirrored(q.to_view, q.normal).dot(q.surface) >= 0;
    if (was_usable) CHECK(n == q.normal);
    ++(was_usable ? kept : bent);
  }
  CHECK(kept > 4000);
  CHECK(bent > 4000);
}

TEST_CASE("a viewer behind an interpolated normal grazes the surface that it is of") {
  size_t behind = 0;
  for (const BendQuery& q : Queries()) {
    const Vec3d v = GrazingView(q.normal, q.to_view);
    CHECK(std::abs(v.length() - 1) <= 2e-15);
    if (q.normal.dot(q.to_view) >= kMinViewCosine) {
      CHECK(v == q.to_view);
      continue;
    }
    ++behind;
    // The cosine survives the rounding of both vectors, and the azimuth stays.
    CHECK(Vec3f(v).dot(Vec3f(q.normal)) > 0);
    CHECK(v.dot(q.normal) >= kMinViewCosine - 1e-15);
    CHECK(v.dot(q.normal) * q.normal.cross(q.to_view).length() <= kMinViewCosine + 1e-15);
    CHECK(std::abs(v.dot(q.normal.cross(q.to_view))) <= 1e-14);
  }
  CHECK(behind > 4000);
  const Vec3d straight = GrazingView(Vec3d(0, 0, 1), Vec3d(0, 0, -1));
  CHECK(std::isfinite(straight.x + straight.y + straight.z));
}

TEST_CASE("bending a normal is continuous where it begins") {
  // As the normal leans away, the mirror direction passes from above the surface to below it.
  const Vec3d surface(0, 0, 1), to_view = Vec3d(1, 0, 0.3).normalized();
  const double view = std::atan2(to_view.x, to_view.z);  // from the surface's normal
  // It lies in the surface where the normal is halfway between viewer and horizon.
  const double edge = (view - M_PI / 2) / 2;
  const auto at = [&](double angle) {
    return BendNormal(Vec3d(std::sin(angle), 0, std::cos(angle)), surface, to_view);
  };
  CHECK((at(edge + 1e-9) - at(edge - 1e-9)).length() <= 2e-9);
  CHECK((at(edge - 0.3) - at(edge)).length() <= 1e-15);  // leaning further changes nothing
  // A view direction straight above, and a normal in the surface.
  const Vec3d straight = BendNormal(Vec3d(0, 1, 0), surface, surface);
  CHECK((straight - Vec3d(0, 1, 1).normalized()).length() <= 1e-15);
  // A view direction in the surface's own plane.
  const Vec3d none = BendNormal(Vec3d(-1, 0, 1e-17), surface, Vec3d(1, 0, 0));
  CHECK(std::isfinite(none.x + none.y + none.z));
  CHECK(none.dot(Vec3d(1, 0, 0)) >= 0);
}

TEST_CASE("bent normals are those of the scalar twin on every target") {
  const std::vector<BendQuery> queries = Queries();
  ForEachTarget([&](Target) {
    const std::vector<Vec3d> bent = AskBend(queries);
    REQUIRE(bent.size() == queries.size());
    double worst = 0;
    for (size_t i = 0; i < bent.size(); ++i) {
      const BendQuery& q = queries[i];
      const Vec3d expected = BendNormal(q.normal, q.surface, q.to_view);
      // Differences in rounding are divided by the view direction's height above the surface.
      const double height = q.to_view.dot(q.surface);
      worst = std::max(worst, (bent[i] - expected).length() * height);
    }
    CHECK(worst <= 1e-14);
    const std::vector<Vec3d> views = AskGrazing(queries);
    for (size_t i = 0; i < views.size(); ++i) {
      const Vec3d expected = GrazingView(queries[i].normal, queries[i].to_view);
      CHECK((views[i] - expected).length() <= 1e-14);
    }
  });
}

}  // namespace
}  // namespace nacre
