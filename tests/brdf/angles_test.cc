// SPDX-License-Identifier: Apache-2.0
// tests/brdf/angles_test.cc: the angles of brdf/angles.h and fresnel.h are those of the normalised
// half vector, where that can be trusted.
#include "brdf/angles.h"

#include <cmath>
#include <random>

#include "brdf/fresnel.h"
#include "catch.h"

namespace nacre {
namespace {

TEST_CASE("angles are those of the half vector") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto direction = [&] {
    return Vec3d{uniform(random), uniform(random), uniform(random)}.normalized();
  };
  for (int i = 0; i < 1000; ++i) {
    const Vec3d n = direction(), l = direction(), v = direction();
    if ((l ^ v) < -0.9) continue;  // a short l + v has no digits
    const Vec3d h = (l + v).normalized();
    const Angles<double> a = ComputeAngles(n, l, v);
    CHECK(a.n_dot_l == Approx(n ^ l).margin(1e-14));
    CHECK(a.n_dot_v == Approx(n ^ v).margin(1e-14));
    CHECK(a.n_dot_u / std::sqrt(a.u_squared) == Approx(n ^ h).margin(1e-14));
    CHECK(a.nxu_squared / a.u_squared == Approx((n % h).length2()).margin(1e-14));
    CHECK(VDotH(a) == Approx(v ^ h).epsilon(1e-13));
    CHECK(OneMinusVDotH(a) == Approx(1 - (v ^ h)).margin(1e-14));
  }
}

}  // namespace
}  // namespace nacre
