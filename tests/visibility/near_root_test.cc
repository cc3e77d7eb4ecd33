// SPDX-License-Identifier: Apache-2.0
// tests/visibility/near_root_test.cc: distances to huge spheres close to the eye.
#include <cmath>

#include "catch.h"
#include "visibility/sphere_test.h"

namespace nacre {
namespace {

TEST_CASE("the near root of a huge sphere keeps its digits") {
  // One unit above a sphere of radius 1e6. All of these numbers and the product of the roots are
  // exact in double; only a difference of the roots would lose digits, six of sixteen.
  const double radius = 1e6;
  const Vec3d to_center(0, -(radius + 1), 0);
  for (const Vec3d& direction : {Vec3d(3, -4, 0), Vec3d(0, -5, 12), Vec3d(1, -2, 2)}) {
    const SphereHit<double> hit = TestSphere(to_center, direction, radius);
    REQUIRE(hit.hit);
    const long double dd = direction.dot(direction);
    const long double b = to_center.dot(direction) / dd;
    const long double c = (2 * radius + 1) / dd;
    const long double expected = c / (b + std::sqrt(b * b - c));
    CAPTURE(direction.x, direction.y, direction.z);
    CHECK(hit.t == Approx(static_cast<double>(expected)).epsilon(1e-14));
  }
}

}  // namespace
}  // namespace nacre
