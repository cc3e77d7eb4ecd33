// SPDX-License-Identifier: Apache-2.0
// tests/brdf/normalization_test.cc: the normalised lobes of the Phong family reflect all light
// that comes along the normal.
#include <cmath>

#include "brdf/phong.h"
#include "brdf/quadrature.h"
#include "catch.h"

namespace nacre {
namespace {

// int lobe(theta) cos(theta) over the hemisphere about the normal, which the light comes along.
template <class Lobe>
double Reflectance(const Lobe& lobe) {
  const QuadratureRule& rule = GaussLegendre(32);
  double sum = 0;
  for (size_t i = 0; i < rule.x.size(); ++i) {
    const double theta = rule.x[i] * M_PI_2;
    sum += rule.w[i] * lobe(theta) * std::cos(theta) * std::sin(theta);
  }
  return sum * M_PI_2 * 2 * M_PI;
}

TEST_CASE("normalised lobes reflect all light along the normal") {
  for (const double n : {0.0, 1.0, 8.0, 64.0}) {
    CAPTURE(n);
    const double phong = Reflectance([n](double theta) { return std::pow(std::cos(theta), n); });
    const double blinn =
        Reflectance([n](double theta) { return std::pow(std::cos(theta / 2), n); });
    CHECK(PhongNormalization(n) * phong == Approx(1).epsilon(1e-10));
    CHECK(BlinnNormalization(n) * blinn == Approx(1).epsilon(1e-10));
  }
}

}  // namespace
}  // namespace nacre
